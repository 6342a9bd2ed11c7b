#include "touch_bounds.hpp"

#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "answer/crew.hpp"
#include "outline/turn.hpp"
#include "touch/measured.hpp"
#include "touch/mirror_poses.hpp"
#include "touch/requirements.hpp"

// Notation, as in docs/touch.md, "How it works":
//   q_i, delta_i    a touch's measured centre, and how far it may be off: `Measured::at`, `place_most`
//   tau_i, eps_i    tangent in the world by a measured normal: `tangent`, `angle_most`
//   a, b, c         cells of the first two touches, the pair, and of another one
//   phi +- h        the part's headings: HeadingArc
//   (z, rho)        disc of the vector from the centre at one cell to that at another: CentreCells::between
// Tests: |R(phi) z - (q_b - q_a)| <= rho + delta_a + delta_b for some phi; |tau - Theta - phi| <= w + eps; and
// |z_ac - R(-phi)(q_c - q_a)| <= rho + delta_a + delta_c + 2 |q_c - q_a| sin(h / 2), from a and from b.
// Follows docs/identify.md, "Touches".
// Idea: the search of src/touch/cell_search.cpp, on what is known of a part without loading it. It stops at the first
// pair of the finest cells that may hold all touches: then the part is left.
namespace rollfix {
namespace {

using touch::HeadingArc;
using touch::Measured;

// Parts that a thread looks at in one go: in memory, and with what is read from the file.
constexpr std::size_t kTouchBlock = 256;
constexpr std::size_t kTouchReadBlock = 64;
// A cell has so many of the next finer ones in it.
constexpr std::size_t kFiner = 4;
// Headings are rounded, radians.
constexpr double kHeadingGrain = 1e-9;

/// One part: whether there is a pair of cells, and a cell for each other touch, that may go together.
class CellPairs {
 public:
  CellPairs(const std::vector<Measured>& touches, const touch::TouchPair& pair, const std::vector<CentreCells>& levels)
      : touches_(touches), pair_(pair), levels_(levels) {
    for (std::size_t k = 0; k < touches.size(); ++k) {
      if (k != pair.first && k != pair.second) others_.push_back(k);
    }
  }

  bool may_hold_all() {
    const std::size_t count = levels_.front().size();
    Lists lists;
    for (std::size_t k = 0; k < others_.size(); ++k) {
      lists.emplace_back(candidates_.size(), candidates_.size() + count);
      for (std::size_t cell = 0; cell < count; ++cell) candidates_.push_back(cell);
    }
    for (std::size_t a = 0; a < count; ++a) {
      for (std::size_t b = 0; b < count; ++b) {
        if (may_hold(0, a, b, lists)) return true;
      }
    }
    return false;
  }

 private:
  using Lists = std::vector<std::pair<std::size_t, std::size_t>>;  // of each other touch, in candidates_

  const Vec2& at(std::size_t touch) const { return touches_[touch].at; }
  double slack(std::size_t one, std::size_t other) const {
    return touches_[one].place_most + touches_[other].place_most;
  }

  HeadingArc by_normal(const CentreCells& cells, std::size_t touch, std::size_t cell) const {
    const Measured& one = touches_[touch];
    if (!one.tangent) return {};
    return {nearest_angle(*one.tangent - cells.angle(cell)), cells.half_turn(cell) + one.angle_most + kHeadingGrain};
  }

  HeadingArc headings(const CentreCells& cells, std::size_t a, std::size_t b) const {
    const HeadingArc normals = common(by_normal(cells, pair_.first, a), by_normal(cells, pair_.second, b));
    if (normals.is_empty()) return normals;
    const Disc chord = cells.between(a, b);
    return common(normals, touch::headings_between(chord.middle, at(pair_.second) - at(pair_.first),
                                                   chord.radius + slack(pair_.first, pair_.second)));
  }

  /// Whether these two, with what they leave to the others, may hold all touches: in one of the finest cells in them.
  bool may_hold(std::size_t level, std::size_t a, std::size_t b, const Lists& lists) {
    const CentreCells& cells = levels_[level];
    const HeadingArc arc = headings(cells, a, b);
    if (arc.is_empty()) return false;
    const std::size_t top = candidates_.size();
    const bool is_finest = level + 1 == levels_.size();
    Lists own = lists;
    bool fits = true;
    for (std::size_t k = 0; k < others_.size() && fits; ++k) fits = narrow(level, {a, b}, arc, others_[k], own[k]);
    if (fits && !is_finest) {
      fits = false;
      for (std::size_t i = 0; i < kFiner * kFiner && !fits; ++i) {
        fits = may_hold(level + 1, kFiner * a + i / kFiner, kFiner * b + i % kFiner, own);
      }
    }
    candidates_.resize(top);
    return fits;
  }

  /// Of a list of cells those in which another touch can be, as a new one on the stack: of the next finer cells, or of
  /// the finest at least one.
  bool narrow(std::size_t level, const std::array<std::size_t, 2>& pair, const HeadingArc& arc, std::size_t touch,
              std::pair<std::size_t, std::size_t>& list) {
    const bool is_finest = level + 1 == levels_.size();
    const std::size_t top = candidates_.size();
    const std::array<std::size_t, 2> touches = {pair_.first, pair_.second};
    std::array<Vec2, 2> wanted;
    std::array<double, 2> reach{};
    const double swing = arc.is_all() ? 2 : 2 * std::sin(0.5 * arc.half);
    const double cosine = std::cos(arc.middle), sine = std::sin(arc.middle);
    for (std::size_t k = 0; k < 2; ++k) {
      const Vec2 vector = at(touch) - at(touches[k]);
      wanted[k] = {cosine * vector.x() + sine * vector.y(), cosine * vector.y() - sine * vector.x()};
      reach[k] = slack(touch, touches[k]) + swing * vector.norm();
    }
    const Measured& one = touches_[touch];
    const CentreCells& cells = levels_[level];
    for (std::size_t k = list.first; k < list.second; ++k) {
      const std::size_t cell = candidates_[k];
      if (one.tangent) {
        const double off = std::abs(nearest_angle(*one.tangent - cells.angle(cell) - arc.middle));
        if (off > cells.half_turn(cell) + one.angle_most + arc.half + kHeadingGrain) continue;
      }
      const auto is_within = [&](std::size_t i) {
        const Disc disc = cells.between(pair[i], cell);
        const double most = reach[i] + disc.radius;
        return (disc.middle - wanted[i]).squaredNorm() <= most * most;
      };
      if (!is_within(0) || !is_within(1)) continue;
      if (is_finest) return true;
      for (std::size_t i = 0; i < kFiner; ++i) candidates_.push_back(kFiner * cell + i);
    }
    list = {top, candidates_.size()};
    return list.first != list.second;
  }

  const std::vector<Measured>& touches_;
  touch::TouchPair pair_;
  const std::vector<CentreCells>& levels_;
  std::vector<std::size_t> others_;
  std::vector<std::size_t> candidates_;  // a stack
};

}  // namespace

TouchBounds::TouchBounds(const Catalog& catalog, const TouchProblem& like)
    : catalog_(catalog), index_(catalog.index()), radius_(touch::radius_of(like)) {
  touches_ = touch::measured(like.mirrored ? touch::in_mirror(like) : like);
  if (touches_.size() > 1) pair_ = touch::choose_pair(touches_);
}

std::vector<CentreCells> TouchBounds::cells_in_memory(std::size_t part) const {
  const CatalogEntry& entry = catalog_.entry(part);
  return {{index_.coarse[part], entry.perimeter, entry.closed, radius_},
          {index_.cells[part], entry.perimeter, entry.closed, radius_}};
}

CentreCells TouchBounds::cells_of(std::size_t part, const Profile<kFineCells>& fine) const {
  const CatalogEntry& entry = catalog_.entry(part);
  return {fine, entry.perimeter, entry.closed, radius_};
}

std::vector<std::size_t> TouchBounds::left_of(const std::vector<std::size_t>& parts,
                                              const IdentifyOptions& options) const {
  if (touches_.size() < 2) return parts;
  std::vector<char> may_be(parts.size(), 0);
  const auto ask = [&](std::size_t k, const std::vector<CentreCells>& levels) {
    may_be[k] = CellPairs(touches_, pair_, levels).may_hold_all() ? 1 : 0;
  };
  const auto left = [&] {
    std::vector<std::size_t> some;
    for (std::size_t k = 0; k < parts.size(); ++k) {
      if (may_be[k] != 0) some.push_back(k);
    }
    return some;
  };
  Crew in_memory(parts.size(), kTouchBlock);
  in_memory.run(options.threads, {}, [&](std::size_t lo, std::size_t hi) {
    for (std::size_t k = lo; k < hi; ++k) ask(k, cells_in_memory(parts[k]));
  });
  in_memory.require_done();
  const std::vector<std::size_t> closely = left();
  Crew crew(closely.size(), kTouchReadBlock);
  crew.run(options.threads, options.go_on, [&](std::size_t lo, std::size_t hi) {
    std::vector<std::size_t> block;
    for (std::size_t i = lo; i < hi; ++i) block.push_back(parts[closely[i]]);
    const std::vector<Profile<kFineCells>> fine = index_.fine(block);
    for (std::size_t i = lo; i < hi; ++i) {
      std::vector<CentreCells> levels = cells_in_memory(block[i - lo]);
      levels.push_back(cells_of(block[i - lo], fine[i - lo]));
      ask(closely[i], levels);
    }
  });
  crew.require_done();
  std::vector<std::size_t> result;
  for (const std::size_t k : left()) result.push_back(parts[k]);
  return result;
}

}  // namespace rollfix
