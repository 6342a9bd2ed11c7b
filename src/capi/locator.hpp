#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <memory_resource>
#include <new>
#include <optional>
#include <vector>

#include "belief/one/grid.hpp"
#include "log/roll_rows.hpp"
#include "rollfix/belief.hpp"
#include "rollfix/part.hpp"

namespace rollfix::capi {

/// Memory for all that is ever asked of it, taken once. What is given back serves the next that asks for as much, to a
/// quarter: sizes are rounded up to four for each power of two, and blocks are neither cut nor joined. Throws
/// std::bad_alloc where nothing is left.
class FixedPool : public std::pmr::memory_resource {
 public:
  explicit FixedPool(std::size_t bytes) : memory_(new std::byte[bytes]), bytes_(bytes) {}

  std::size_t bytes() const { return bytes_; }
  std::size_t used() const { return used_; }  // at most so far
  /// All that was taken is free again. REQUIRES that nobody uses it.
  void clear() {
    used_ = 0;
    free_.fill(nullptr);
  }

 private:
  struct Free {
    Free* next;
  };
  static constexpr std::size_t kLeast = 64;  // as aligned as anything is
  static constexpr std::size_t kClasses = 4 * 58;

  struct Block {
    std::size_t bytes;
    std::size_t number;  // of its class
  };
  static Block block_of(std::size_t bytes) {
    std::size_t power = kLeast;
    std::size_t number = 0;
    for (; 2 * power < bytes; power *= 2) number += 4;
    if (bytes <= power) return {power, number};
    const std::size_t step = power / 4;
    const std::size_t steps = (bytes - power + step - 1) / step;
    return {power + steps * step, number + steps};
  }

  void* do_allocate(std::size_t bytes, std::size_t /*alignment*/) override {
    const Block block = block_of(bytes);
    if (Free* const one = free_[block.number]) {
      free_[block.number] = one->next;
      return one;
    }
    const std::size_t aligned = (block.bytes + kLeast - 1) / kLeast * kLeast;
    void* place = memory_.get() + used_;
    std::size_t left = bytes_ - used_;
    if (std::align(kLeast, aligned, place, left) == nullptr) throw std::bad_alloc();
    used_ = bytes_ - left + aligned;
    return place;
  }
  void do_deallocate(void* place, std::size_t bytes, std::size_t /*alignment*/) override {
    Free*& first = free_[block_of(bytes).number];
    first = new (place) Free{first};
  }
  bool do_is_equal(const std::pmr::memory_resource& other) const noexcept override { return this == &other; }

  std::unique_ptr<std::byte[]> memory_;
  std::size_t bytes_;
  std::size_t used_ = 0;
  std::array<Free*, kClasses> free_{};
};

/// A log of increments on a course, as Belief takes it: the same nodes on the same grid with the same modes, in memory
/// that is taken once.
class Locator {
 public:
  /// `points`: of the grid, at most; 0: as many as recommended. Throws InputError: noise that is not valid, or fewer
  /// points than the grid begins with.
  Locator(const Part& part, const Noise& noise, std::size_t points);
  Locator(const Locator&) = delete;
  Locator& operator=(const Locator&) = delete;

  /// Why such a row can't be taken; nullptr: it can.
  const char* refusal(double seconds, double distance, double turn) const;
  /// Throws std::bad_alloc: from then on all is used up.
  void push(double seconds, double distance, double turn);
  /// REQUIRES a row. Throws std::bad_alloc likewise.
  void locate();
  void restart();

  bool is_used_up() const { return is_used_up_; }
  std::size_t bytes() const { return pool_.bytes(); }
  std::size_t used() const { return pool_.used(); }
  std::size_t rows() const { return belief_->nodes.rows(); }
  const Part& part() const { return part_; }
  // Of the last locate().
  const Fit& fit() const { return belief_->grid.fit(); }
  const Verdict& verdict() const { return verdict_; }
  const std::pmr::vector<Mode>& modes() const { return belief_->modes; }
  double rest() const;

 private:
  struct Increment {
    double seconds = 0;
    double distance = 0;
    double turn = 0;
  };
  /// What is made anew for every log.
  struct LogBelief {
    explicit LogBelief(Locator& locator);

    Odometer odometer{LogKind::increments, false};  // adds up as a reader does
    belief::Nodes nodes;
    belief::Grid grid;
    std::pmr::vector<Mode> modes;
    std::optional<double> start_time;
    std::optional<Increment> first{};  // until it is known how long it took
    belief::Row last;
  };

  bool has_times() const { return options_.noise.drift > 0 || options_.noise.walk > 0; }
  /// What a grid of so many points takes at most.
  std::size_t bytes_for(std::size_t points) const;
  void add(const Increment& row);
  template <class Work>
  void use_memory(const Work& work);

  Part part_;
  BeliefOptions options_;
  belief::ErrorModel errors_;
  belief::TiltedBoundary boundary_;
  std::size_t points_;
  FixedPool pool_;
  std::optional<LogBelief> belief_;
  Verdict verdict_{Verdict::unobservable};
  bool is_used_up_ = false;
};

}  // namespace rollfix::capi
