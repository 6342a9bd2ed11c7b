#pragma once

#include <cstddef>
#include <deque>
#include <optional>
#include <vector>

#include "contact_arcs.hpp"
#include "pin_look.hpp"

namespace rollfix_verify {

/// First contacts, of each finger with skin on some arc.
using HeldSet = std::vector<Interval>;

/// What came of a search.
struct HoldCovered {
  std::size_t boxes = 0;      // that were looked at
  std::size_t undecided = 0;  // of the smallest size, that nothing excludes
  std::size_t open = 0;       // in what is left open
  std::vector<double> first_undecided{};

  /// So much was undecided that the rest was not looked at.
  bool is_cut_short() const { return undecided >= kMostUndecided; }
  static constexpr std::size_t kMostUndecided = 100;
};

/// Whether all first contacts that fit at every instant are in some sets: halves boxes of first contacts until each is
/// excluded at some instant, or inside one of those.
class HoldSearch {
 public:
  /// REQUIRES fingers with the same instants as the wheels.
  HoldSearch(BoundaryArcs& boundary, const std::vector<HeldFinger>& fingers, std::deque<PinLook>& wheels,
             std::vector<HeldSet> listed, std::vector<HeldSet> open);

  HoldCovered run();

 private:
  using Nodes = std::vector<int>;  // of each finger's first contacts

  void visit(const Nodes& box);
  bool is_in(const std::vector<HeldSet>& sets, const Nodes& box) const;
  bool may_fit(const Nodes& box);
  std::optional<Interval> headings(const Nodes& box, std::size_t instant);
  bool keep_chord(const Nodes& box, std::size_t instant, std::size_t one, std::size_t other, double base,
                  Interval& offsets);
  bool may_touch(const Nodes& box, std::size_t instant, const Interval& heading, std::vector<Zeros>& zeros);
  void add_undecided(const Nodes& box);

  BoundaryArcs& boundary_;
  const std::vector<HeldFinger>& fingers_;
  std::deque<PinLook>& wheels_;
  std::vector<HeldSet> listed_;
  std::vector<HeldSet> open_;
  std::deque<FirstContacts> contacts_;
  std::vector<std::size_t> order_;  // instants
  double rounding_ = 0;
  HoldCovered covered_;
};

}  // namespace rollfix_verify
