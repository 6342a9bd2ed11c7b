#pragma once

#include <cstddef>
#include <memory_resource>
#include <optional>
#include <vector>

#include "belief/one/grid.hpp"
#include "capi/fixed_pool.hpp"
#include "log/roll_rows.hpp"
#include "rollfix/belief.hpp"
#include "rollfix/part.hpp"

namespace rollfix::capi {

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
