#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstddef>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "certify/places.hpp"
#include "random_outlines.hpp"
#include "rollfix/part.hpp"
#include "shapes.hpp"
#include "told_lies.hpp"

// Lies about two fingers' answers, told by one who knows the format: from a certificate that is true, one that is not,
// with all that belongs together changed together.
namespace pair_liar {

using random_outlines::uniform;
using told_lies::Json;

/// Of this part.
struct Document : told_lies::Document {
  const rollfix::Part& part;

  std::size_t count() const { return json["placements"].size(); }
  std::size_t any_index() { return index_in(json["placements"]); }
  Json& any_placement() { return any(json["placements"]); }

  /// Gives the cells of one placement to another, or other words.
  void rename(const std::string& from, const std::string& to) {
    std::string cells = json["cells"];
    for (std::size_t at = 0; (at = cells.find(from, at)) != std::string::npos; at += to.size()) {
      cells.replace(at, from.size(), to);
    }
    json["cells"] = cells;
  }
  static std::string cell_of(std::size_t k) { return fmt::format("[{}]", k); }

  /// Takes a placement out of the list, and its number out of the cells: what its cells say now is `instead`.
  void remove(std::size_t k, const std::string& instead) {
    rename(cell_of(k), "#");
    for (std::size_t later = k + 1; later < count(); ++later) rename(cell_of(later), cell_of(later - 1));
    rename("#", instead);
    json["placements"].erase(k);
  }

  /// Clearly no pair that fits: far from corners, and off by many tolerances.
  bool misses(double s, double t) const {
    const auto turned = [&](double at, double length) {
      return part.turning().angle(at + length) - part.turning().angle(at);
    };
    const auto is_clear = [&](double at) {
      return std::all_of(part.corners().begin(), part.corners().end(), [&](const rollfix::Corner& corner) {
        return part.boundary().distance(at, corner.s) > 1e-6 * part.perimeter();
      });
    };
    double most = 0;
    for (const Json& reading : json["readings"]) {
      const double a = reading["length"][0], b = reading["length"][1], turn = reading["turn"];
      if (!is_clear(s) || !is_clear(s + a) || !is_clear(t) || !is_clear(t + b)) return false;
      most = std::max(most, std::abs(turned(s, a) - turned(t, b) - turn));
    }
    return most > 20 * json["tolerance"].get<double>() + 1e-8;
  }

  /// Lets a placement be elsewhere, with all that is computed of it.
  void move(Json& placement, double s, double t) const {
    const Json& length = json["readings"].back()["length"];
    const std::array<double, 2> start = {part.boundary().base(s), part.boundary().base(t)};
    for (std::size_t k = 0; k < 2; ++k) {
      const rollfix::CurvePlace at = rollfix::certifying::place_of(part, start[k]);
      const rollfix::Vec2 point = part.point(start[k]);
      placement["start"][k] = start[k];
      placement["end"][k] = part.boundary().base(start[k] + length[k].get<double>());
      placement["at"][k] = {at.curve, at.u};
      placement["point"][k] = {point.x(), point.y()};
      if (placement.contains("tangent")) {
        placement["tangent"][k] = std::remainder(part.tangent(start[k]), 2 * shapes::kPi);
      }
    }
  }
};

using Lie = told_lies::Lie<Document>;

namespace making {

inline std::function<bool(Document&)> on_placement(const std::function<void(Document&, Json&)>& change) {
  return [change](Document& lie) {
    if (lie.count() == 0) return false;
    change(lie, lie.any_placement());
    return true;
  };
}

inline std::function<bool(Document&)> kind(const char* from, const char* to) {
  return [=](Document& lie) {
    for (Json& placement : lie.json["placements"]) {
      if (placement["kind"] != from) continue;
      placement["kind"] = to;
      return true;
    }
    return false;
  };
}

inline std::function<bool(Document&)> asked(double turn, double a, double b) {
  return [=](Document& lie) {
    if (lie.count() == 0) return false;  // of nothing that fits another question may be as true
    Json& reading = lie.json["readings"].back();
    Document::add(reading["turn"], turn);
    Document::add(reading["length"][0], a * lie.part.perimeter());
    Document::add(reading["length"][1], b * lie.part.perimeter());
    return true;
  };
}

/// To a neighbour that is another placement.
inline bool left_to_another(Document& lie) {
  if (lie.count() < 2) return false;
  const std::size_t k = lie.any_index();
  lie.remove(k, Document::cell_of(k == 0 ? 0 : k - 1));
  return true;
}

inline std::function<bool(Document&)> moved(double ds, double dt) {
  return [=](Document& lie) {
    if (lie.count() == 0) return false;
    Json& one = lie.any_placement();
    const double s = one["start"][0].get<double>() + ds * lie.part.perimeter();
    const double t = one["start"][1].get<double>() + dt * lie.part.perimeter();
    if (!lie.misses(s, t)) return false;  // along a continuum
    lie.move(one, s, t);
    return true;
  };
}

inline bool invented(Document& lie, const char* kind, bool takes_a_cell) {
  if (lie.count() == 0) return false;
  Json placement = lie.any_placement();
  placement["kind"] = kind;
  placement.erase("box");
  placement["proof"] = "fits";
  const double s = uniform(lie.generator, 0, lie.part.perimeter());
  const double t = uniform(lie.generator, 0, lie.part.perimeter());
  if (!lie.misses(s, t)) return false;
  lie.move(placement, s, t);
  if (takes_a_cell) {  // one that is excluded
    std::string cells = lie.json["cells"];
    const std::size_t at = cells.find_first_of("0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZ", cells.size() / 2);
    if (at == std::string::npos || cells[at - 1] == '[' || std::isdigit(cells[at - 1]) != 0) return false;
    lie.json["cells"] = cells.replace(at, 1, Document::cell_of(lie.count()));
  }
  lie.json["placements"].push_back(placement);
  return true;
}

}  // namespace making

inline const std::vector<Lie>& all() {
  using namespace making;
  static const std::vector<Lie> lies = {
      {"one left out, its cells excluded",
       [](Document& lie) {
         if (lie.count() == 0) return false;
         lie.remove(lie.any_index(), "Y");
         return true;
       }},
      {"one left out, its cells another's", left_to_another},
      {"all left out, all cells excluded",
       [](Document& lie) {
         if (lie.count() == 0) return false;
         while (lie.count() > 0) lie.remove(lie.count() - 1, "Y");
         return true;
       }},
      {"all cells excluded, the list stays",
       [](Document& lie) {
         if (lie.count() == 0) return false;
         for (std::size_t k = 0; k < lie.count(); ++k) lie.rename(Document::cell_of(k), "Y");
         return true;
       }},
      {"one twice", on_placement([](Document& lie, Json& one) { lie.json["placements"].push_back(Json(one)); })},
      {"one invented, without a cell", [](Document& lie) { return invented(lie, "touching", false); }},
      {"one invented, with a cell", [](Document& lie) { return invented(lie, "touching", true); }},
      {"a continuum invented, with a cell", [](Document& lie) { return invented(lie, "stretch", true); }},
      {"one moved", moved(0.01, -0.01)},
      {"one moved, its box left", moved(1e-4, 0)},
      {"another end", on_placement([](Document& lie, Json& one) {
         one["end"][0] = lie.part.boundary().base(one["end"][0].get<double>() + 1e-3 * lie.part.perimeter());
       })},
      {"another point", on_placement([](Document& /*lie*/, Json& one) { one["point"][1][0] = 7.0; })},
      {"fingers exchanged in one",
       [](Document& lie) {
         if (lie.count() == 0) return false;
         Json& one = lie.any_placement();
         const double s = one["start"][0], t = one["start"][1];
         if (!lie.misses(t, s)) return false;
         lie.move(one, t, s);
         return true;
       }},
      {"a crossing said to touch", kind("crossing", "touching")},
      {"a crossing said to be a corner", kind("crossing", "corner")},
      {"a crossing said to be a stretch", kind("crossing", "stretch")},
      {"a corner said to be a crossing", kind("corner", "crossing")},
      {"a corner said to be a stretch", kind("corner", "stretch")},
      {"a stretch said to be a crossing", kind("stretch", "crossing")},
      {"a kind that is not", on_placement([](Document& /*lie*/, Json& one) { one["kind"] = "banana"; })},
      {"the only one, of what is not", on_placement([](Document& /*lie*/, Json& one) {
         one["proof"] = one["proof"] == "one" ? "banana" : "one";
         one.erase("box");
       })},
      {"another turn", asked(0.05, 0, 0)},
      {"a whole turn more", asked(2 * shapes::kPi, 0, 0)},
      {"another length of a", asked(0, 0.03, 0)},
      {"another length of b", asked(0, 0, -0.03)},
      {"a lap more of a, its turn not", asked(0, 1, 0)},
      {"an open one said to be closed",
       [](Document& lie) {
         if (lie.part.closed()) return false;
         const double P = lie.part.perimeter();
         lie.json["closed"] = true;
         lie.json["gap"] = (lie.part.point(P) - lie.part.point(0)).norm();
         return true;
       }},
      {"another perimeter",
       [](Document& lie) {
         Document::scale(lie.json["perimeter"], 1.001);
         return true;
       }},
      {"a facing of too many digits",
       [](Document& lie) {
         lie.json["facing"] = 1e20;
         return true;
       }},
      {"half of the cells",
       [](Document& lie) {
         const std::string cells = lie.json["cells"];
         lie.json["cells"] = cells.substr(0, cells.size() / 2);
         return true;
       }},
  };
  return lies;
}

}  // namespace pair_liar
