#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <csignal>
#include <cstddef>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

#include "rollfix/error.hpp"
#include "rollfix/pulse.hpp"

namespace rollfix {

/// As long as it lives signals wait for this thread, and for those that it starts: none ends the program with files
/// half written.
class SignalsWait {
 public:
  SignalsWait() {
    sigset_t all;
    ::sigfillset(&all);
    ::pthread_sigmask(SIG_BLOCK, &all, &before_);
  }
  ~SignalsWait() { ::pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
  SignalsWait(const SignalsWait&) = delete;
  SignalsWait& operator=(const SignalsWait&) = delete;

 private:
  sigset_t before_ = {};
};

// How long nobody is asked whether to go on: short for a person, long for a machine.
inline constexpr std::chrono::milliseconds kMostSilence{50};

/// Blocks of work for several threads, and the first exception of one of them. Where the work is stopped threads do not
/// end the block that they are at; whoever waits is the one that the caller's Pulse beats in.
class Crew {
 public:
  Crew(std::size_t count, std::size_t block) : count_(count), block_(block) {}

  /// `work(lo, hi)` does a block.
  template <class Work>
  void run(unsigned threads, const std::function<bool(std::size_t)>& go_on, const Work& work) {
    const std::size_t blocks = (count_ + block_ - 1) / block_;
    const std::size_t wanted = threads > 0 ? threads : std::max(1U, std::thread::hardware_concurrency());
    const std::size_t crew = std::min(wanted, blocks);
    pulse_ = Pulse::current();
    if (crew <= 1 && !go_on) return serve(work);
    std::vector<std::thread> all;
    {
      const std::lock_guard lock(mutex_);
      working_ = crew;
    }
    const auto help = [&] {
      const Pulse stopping([this](const char* /*doing*/) {
        if (stop_) throw Stopped();
      });
      serve(work);
      const std::lock_guard lock(mutex_);
      --working_;
      ended_.notify_all();
    };
    try {
      const SignalsWait wait;  // signals are for the thread that asks: it knows when the program may end
      while (all.size() < crew) all.emplace_back(help);
    } catch (const std::exception&) {  // there are no more threads, or no memory for them: fewer do it as well
      const std::lock_guard lock(mutex_);
      working_ -= crew - all.size();
    }
    if (all.empty()) return serve_alone(go_on, work);
    wait(go_on);
    for (std::thread& thread : all) thread.join();
  }

  /// Throws what a thread threw, and InputError where the work was stopped.
  void require_done() const {
    if (thrown_) std::rethrow_exception(thrown_);
    if (stopped_) throw InputError("solve: stopped before all problems were done");
  }

 private:
  struct Stopped {};  // in the middle of a block

  template <class Work>
  void serve(const Work& work) {
    try {
      while (!stop_) {
        const std::size_t lo = next_.fetch_add(block_);
        if (lo >= count_) return;
        const std::size_t hi = std::min(lo + block_, count_);
        work(lo, hi);
        done_ += hi - lo;
      }
    } catch (const Stopped&) {  // nothing of its own went wrong
    } catch (...) {
      const std::lock_guard lock(mutex_);
      if (!thrown_) thrown_ = std::current_exception();
      stop_ = true;
    }
  }

  /// In this thread, which asks between two blocks.
  template <class Work>
  void serve_alone(const std::function<bool(std::size_t)>& go_on, const Work& work) {
    serve([&](std::size_t lo, std::size_t hi) {
      work(lo, hi);
      if (!go_on || asks(go_on)) return;
      stopped_ = true;
      stop_ = true;
    });
  }

  void wait(const std::function<bool(std::size_t)>& go_on) {
    std::unique_lock lock(mutex_);
    while (working_ > 0) {
      if (!go_on && pulse_ == nullptr) {
        ended_.wait(lock);
        continue;
      }
      ended_.wait_for(lock, kMostSilence);
      if (stopped_) continue;
      lock.unlock();
      const bool goes_on = asks(go_on);
      lock.lock();
      stopped_ = !goes_on;
      if (stopped_) stop_ = true;
    }
  }

  bool asks(const std::function<bool(std::size_t)>& go_on) {
    try {
      if (pulse_ != nullptr) pulse_->look_up();
      return !go_on || go_on(done_);
    } catch (...) {
      const std::lock_guard lock(mutex_);
      if (!thrown_) thrown_ = std::current_exception();
      return false;
    }
  }

  std::size_t count_;
  std::size_t block_;
  std::atomic<std::size_t> next_{0};
  std::atomic<std::size_t> done_{0};
  std::atomic<bool> stop_{false};
  bool stopped_ = false;  // by go_on or by the pulse
  Pulse* pulse_ = nullptr;
  std::size_t working_ = 0;
  std::exception_ptr thrown_;
  std::mutex mutex_;
  std::condition_variable ended_;
};

/// `work(k)` of each k below `count`, in as many threads as the options say. Throws as `Crew::require_done`.
template <class Options, class Work>
void each_of(std::size_t count, const Options& options, const Work& work) {
  Crew crew(count, 1);
  crew.run(options.threads, options.go_on, [&](std::size_t k, std::size_t /*end*/) { work(k); });
  crew.require_done();
}

}  // namespace rollfix
