#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <random>
#include <string>
#include <vector>

#include "certify/places.hpp"
#include "random_outlines.hpp"
#include "rollfix/part.hpp"
#include "told_lies.hpp"

// Lies about one finger's answers, told by one who knows the format: from a certificate that is true, one that is not,
// with all that belongs together changed together.
namespace liar {

using random_outlines::uniform;
using rollfix::Part;
using rollfix::Reading;
using told_lies::Json;

class Liar : public told_lies::Document {
 public:
  Liar(const told_lies::Document& document, const random_outlines::Question& question)
      : told_lies::Document(document),
        part_(question.part),
        readings_(question.readings),
        tolerance_(question.tolerance) {}

  using Lie = told_lies::Lie<Liar>;
  static const std::vector<Lie>& all();

 private:
  std::size_t any_below(std::size_t count) {
    return std::uniform_int_distribution<std::size_t>(0, count - 1)(generator);
  }

  static Json place_json(const rollfix::CurvePlace& place) { return Json::array({place.curve, place.u}); }
  double base(double s) const { return part_.boundary().base(s); }

  double f(std::size_t reading, double s) const {
    const Reading& one = readings_[reading];
    return part_.turning().angle(s + one.length[0]) - part_.turning().angle(s) - one.turn;
  }

  /// Clearly no placement: far from corners, and off by many tolerances.
  bool misses(double s) const {
    double most = 0;
    for (std::size_t k = 0; k < readings_.size(); ++k) {
      most = std::max(most, std::abs(f(k, s)));
      for (const rollfix::Corner& corner : part_.corners()) {
        for (const double at : {s, s + readings_[k].length[0]}) {
          if (part_.boundary().distance(at, corner.s) < 1e-6 * part_.perimeter()) return false;
        }
      }
    }
    return most > 20 * tolerance_ + 1e-8;
  }

  Json row(double s, const Json& then = nullptr, const Json& by = nullptr) const {
    Json result = {
        {"start", place_json(rollfix::certifying::place_of(part_, s))}, {"end", Json::array()}, {"off", Json::array()}};
    for (std::size_t k = 0; k < readings_.size(); ++k) {
      result["end"].push_back(place_json(rollfix::certifying::place_of(part_, s + readings_[k].length[0])));
      result["off"].push_back(f(k, s) / tolerance_);
    }
    if (!then.is_null()) result["then"] = then;
    if (!by.is_null()) result["by"] = by;
    return result;
  }

  Json placement(double s, const std::string& kind) const {
    const double end = base(s + readings_.back().length[0]);
    const rollfix::Vec2 point = part_.point(base(s));
    Json result = {{"kind", kind},
                   {"start", base(s)},
                   {"end", end},
                   {"at", place_json(rollfix::certifying::place_of(part_, s))},
                   {"point", {point.x(), point.y()}}};
    if (kind != "corner") result["tangent"] = std::remainder(part_.tangent(base(s)), 2 * shapes::kPi);
    return result;
  }

  /// s of a row or of a placement, from what stands in it.
  double s_of(const Json& at) const {
    double s = 0;
    const Json& curves = json["curves"];
    const auto length = [](const Json& curve) {
      const auto n = curve["numbers"].get<std::vector<double>>();
      return curve["kind"] == "arc" ? n[2] * std::abs(n[4]) : std::hypot(n[2] - n[0], n[3] - n[1]);
    };
    const auto index = at[0].get<std::size_t>();
    for (std::size_t k = 0; k < index; ++k) s += length(curves[k]);
    const double whole = curves[index]["kind"] == "arc" ? std::abs(curves[index]["numbers"][4].get<double>()) : 1;
    return s + at[1].get<double>() / whole * length(curves[index]);
  }

  // ---- what lies are made of ----

  /// Rows whose cell is not apart.
  std::vector<std::size_t> cells(bool apart) const {
    std::vector<std::size_t> result;
    const Json& rows = json["rows"];
    for (std::size_t k = 0; k < rows.size(); ++k) {
      if (rows[k].contains("then") && (rows[k]["then"] == "apart") == apart) result.push_back(k);
    }
    return result;
  }

  /// A start in the middle of a cell that is apart, with rows on both sides; the number of that cell.
  bool gap(std::size_t& cell, double& s, double& width) {
    std::vector<std::size_t> wide;
    for (const std::size_t k : cells(true)) {
      if (k + 1 >= json["rows"].size()) continue;
      const double lo = s_of(json["rows"][k]["start"]);
      const double hi = s_of(json["rows"][k + 1]["start"]);
      if (hi - lo > 1e-3 * part_.perimeter() && misses(lo + 0.5 * (hi - lo))) wide.push_back(k);
    }
    if (wide.empty()) return false;
    cell = wide[any_below(wide.size())];
    const double lo = s_of(json["rows"][cell]["start"]);
    width = s_of(json["rows"][cell + 1]["start"]) - lo;
    s = lo + 0.5 * width;
    return true;
  }

  bool invent(const std::string& then, const std::string& kind) {
    std::size_t cell = 0;
    double s = 0;
    double width = 0;
    if (!gap(cell, s, width)) return false;
    const Json by = json["rows"][cell].value("by", Json());
    Json& rows = json["rows"];
    const Json before = row(s - 0.1 * width, then, readings_.size() > 1 ? Json{0} : Json());
    const auto at = rows.begin() + static_cast<std::ptrdiff_t>(cell) + 1;
    rows.insert(rows.insert(at, row(s + 0.1 * width, "apart", by)), before);
    json["placements"].push_back(placement(s, kind));
    return true;
  }

  bool invent_at_corner(bool concave, const std::string& then) {
    for (const rollfix::Corner& corner : part_.corners()) {
      if (corner.is_concave() != concave) continue;
      const double beside = 1e-7 * part_.perimeter();
      double least = 1e9;
      for (const double s : {corner.s - beside, corner.s + beside}) {
        for (std::size_t k = 0; k < readings_.size(); ++k) least = std::min(least, std::abs(f(k, s)));
      }
      const bool pivots = !concave && f(0, corner.s - beside) > 0 && f(0, corner.s + beside) < 0;
      if (least < 1e-3 || pivots || readings_.size() > 1 || !part_.closed()) continue;
      if (corner.s < 3 * beside || corner.s > part_.perimeter() - 3 * beside) continue;
      Json& rows = json["rows"];
      std::size_t k = 0;
      while (k < rows.size() && s_of(rows[k]["start"]) < corner.s) ++k;
      if (k == 0 || k == rows.size() || rows[k - 1]["then"] != "apart") continue;
      const bool is_clear =
          s_of(rows[k - 1]["start"]) < corner.s - 2 * beside && s_of(rows[k]["start"]) > corner.s + 2 * beside;
      if (!is_clear) continue;
      const auto at = rows.begin() + static_cast<std::ptrdiff_t>(k);
      rows.insert(rows.insert(at, row(corner.s + beside, "apart")), row(corner.s - beside, then));
      json["placements"].push_back(placement(corner.s, "corner"));
      return true;
    }
    return false;
  }

  /// The cells of two placements next to each other made one, the second placement left out.
  bool merge(const std::string& then) {
    const std::vector<std::size_t> own = cells(false);
    if (json["placements"].size() < 2 || own.size() != json["placements"].size()) return false;
    const std::size_t k = any_below(own.size() - 1);
    Json& rows = json["rows"];
    if (!then.empty()) rows[own[k]]["then"] = then;
    for (std::size_t i = own[k] + 1; i <= own[k + 1]; ++i) rows.erase(own[k] + 1);
    const double lo = s_of(rows[own[k]]["start"]);
    const double hi = own[k] + 1 < rows.size() ? s_of(rows[own[k] + 1]["start"]) : part_.perimeter();
    Json kept = Json::array();
    int inside = 0;
    for (const Json& one : json["placements"]) {
      const double s = s_of(one["at"]);
      if (s < lo || s > hi || inside++ == 0) kept.push_back(one);
    }
    if (kept.size() == json["placements"].size()) return false;
    json["placements"] = kept;
    return true;
  }

  bool one_round_all(const std::string& then) {
    if (json["placements"].size() < 2 || !part_.closed()) return false;
    Json first = json["rows"][0];
    first["then"] = then;
    first.erase("by");
    json["rows"] = Json::array({first});
    json["placements"] = Json::array({any(json["placements"])});
    return true;
  }

  bool move(double share, bool with_rows) {
    Json& all = json["placements"];
    if (all.empty()) return false;
    Json& one = any(all);
    const double s = s_of(one["at"]);
    const double to = s + share * part_.perimeter();
    if (to < 0 || to > part_.perimeter() || !misses(to)) return false;
    if (!part_.closed() && (to + readings_.back().length[0] < 0 || to + readings_.back().length[0] > part_.perimeter()))
      return false;
    one = placement(to, one["kind"]);
    if (!with_rows) return true;
    for (Json& other : json["rows"]) {
      const double from = s_of(other["start"]);
      if (std::abs(from - s) > 0.5 * std::abs(share) * part_.perimeter()) continue;
      other = row(from + to - s, other.value("then", Json()), other.value("by", Json()));
    }
    return true;
  }

  /// The row from which a placement's cell goes: the last one for what comes before the first one.
  std::size_t cell_of(const Json& placement) const {
    const Json& rows = json["rows"];
    std::size_t k = rows.size();
    while (k > 0 && s_of(rows[k - 1]["start"]) > s_of(placement["at"])) --k;
    return k == 0 ? rows.size() - 1 : k - 1;
  }

  bool change_kind(const std::string& from, const std::string& to, const std::string& then) {
    if (readings_.size() > 1) return false;
    Json& all = json["placements"];
    if (cells(false).size() != all.size()) return false;
    for (std::size_t k = 0; k < all.size(); ++k) {
      if (all[k]["kind"] != from) continue;
      const std::size_t cell = cell_of(all[k]);
      if (from == "crossing" && json["rows"][cell]["then"] != "crossing") continue;
      if (from == "crossing" && to == "corner" && !misses(s_of(all[k]["at"]) + 1e-5 * part_.perimeter())) continue;
      all[k] = placement(s_of(all[k]["at"]), to);
      if (!then.empty()) json["rows"][cell]["then"] = then;
      return true;
    }
    return false;
  }

  /// All rows again, for another question.
  void renew() {
    for (Json& one : json["rows"]) one = row(s_of(one["start"]), one.value("then", Json()), one.value("by", Json()));
    for (std::size_t k = 0; k < readings_.size(); ++k) {
      json["readings"][k] = {{"length", readings_[k].length[0]}, {"turn", readings_[k].turn}};
    }
  }

  bool other_question(double by_turn, double by_length) {
    if (json["placements"].empty()) return false;
    const std::size_t k = any_below(readings_.size());
    readings_[k].turn += by_turn;
    readings_[k].length[0] += by_length * part_.perimeter();
    if (!part_.closed() && by_length != 0) return false;
    bool is_lie = false;
    for (Json& one : json["placements"]) {
      const double s = s_of(one["at"]);
      is_lie = is_lie || misses(s);
      one = placement(s, one["kind"]);
    }
    renew();
    return is_lie;
  }

  const Part& part_;
  std::vector<Reading> readings_;
  double tolerance_;
};

inline const std::vector<Liar::Lie>& Liar::all() {
  const auto invented = [](const char* then, const char* kind) {
    return [=](Liar& liar) { return liar.invent(then, kind); };
  };
  const auto merged = [](const char* then) { return [=](Liar& liar) { return liar.merge(then); }; };
  const auto round = [](const char* then) { return [=](Liar& liar) { return liar.one_round_all(then); }; };
  const auto moved = [](double share, bool rows) { return [=](Liar& liar) { return liar.move(share, rows); }; };
  const auto kind = [](const char* from, const char* to, const char* then) {
    return [=](Liar& liar) { return liar.change_kind(from, to, then); };
  };
  const auto asked = [](double turn, double length) {
    return [=](Liar& liar) { return liar.other_question(turn, length); };
  };
  const auto at_corner = [](bool concave, const char* then) {
    return [=](Liar& liar) { return liar.invent_at_corner(concave, then); };
  };
  static const std::vector<Lie> lies = {
      {"invented, its cell within", invented("within", "touching")},
      {"invented, its cell a crossing", invented("crossing", "crossing")},
      {"invented, its cell a stretch", invented("stretch", "stretch")},
      {"invented, its cell a corner", invented("corner", "corner")},
      {"invented, a corner within", invented("within", "corner")},
      {"invented at a concave corner, its cell a corner", at_corner(true, "corner")},
      {"invented at a concave corner, its cell within", at_corner(true, "within")},
      {"invented at a convex corner, its cell a corner", at_corner(false, "corner")},
      {"invented at a convex corner, its cell within", at_corner(false, "within")},
      {"two merged, the cell kept", merged("")},
      {"two merged within", merged("within")},
      {"two merged to a corner", merged("corner")},
      {"two merged to a crossing", merged("crossing")},
      {"all but one dropped, the cell within", round("within")},
      {"all but one dropped, the cell a stretch", round("stretch")},
      {"all but one dropped, nothing claimed", round("unproved")},
      {"moved a little", moved(1e-5, false)},
      {"moved back", moved(-1e-3, false)},
      {"moved with its rows", moved(1e-4, true)},
      {"moved back with its rows", moved(-1e-5, true)},
      {"a crossing said to touch", kind("crossing", "touching", "")},
      {"a crossing said to be a corner", kind("crossing", "corner", "within")},
      {"a crossing said to be a corner, its cell as well", kind("crossing", "corner", "corner")},
      {"a crossing said to be a stretch", kind("crossing", "stretch", "stretch")},
      {"a corner said to be a stretch", kind("corner", "stretch", "stretch")},
      {"a corner said to be a crossing", kind("corner", "crossing", "crossing")},
      {"a kind that is not",
       [](Liar& liar) {
         Json& list = liar.json["placements"];
         if (list.empty()) return false;
         liar.any(list)["kind"] = "banana";
         return true;
       }},
      {"another turn", asked(0.05, 0)},
      {"a whole turn more", asked(2 * shapes::kPi, 0)},
      {"another length", asked(0, 0.03)},
      {"a lap more, its turn not", asked(0, 1)},
      {"a facing of too many digits",
       [](Liar& liar) {
         liar.json["readings"][0]["turn"] = 1e20;
         return true;
       }},
      {"all excluded",
       [](Liar& liar) {
         if (liar.json["placements"].empty()) return false;
         for (Json& one : liar.json["rows"]) {
           if (one.contains("then")) one["then"] = "apart";
           if (one.contains("then") && liar.readings_.size() > 1) one["by"] = {0};
         }
         liar.json["placements"] = Json::array();
         return true;
       }},
      {"one of them twice",
       [](Liar& liar) {
         Json& list = liar.json["placements"];
         if (list.empty()) return false;
         list.push_back(liar.any(list));
         return true;
       }},
      {"one left out",
       [](Liar& liar) {
         Json& list = liar.json["placements"];
         if (list.empty()) return false;
         list.erase(liar.index_in(list));
         return true;
       }},
      {"an open one said to be closed",
       [](Liar& liar) {
         if (liar.part_.closed()) return false;
         const rollfix::Vec2 first = liar.part_.point(0);
         const rollfix::Vec2 last = liar.part_.point(liar.part_.perimeter());
         liar.json["closed"] = true;
         liar.json["gap"] = (last - first).norm();
         liar.json["rows"].back()["then"] = "unproved";
         return true;
       }},
      {"a wider tolerance",
       [](Liar& liar) {
         if (liar.json["placements"].empty()) return false;
         double most = 0;
         for (const Json& one : liar.json["rows"]) {
           for (const Json& off : one["off"]) most = std::max(most, std::abs(off.get<double>()));
         }
         if (most < 1e3) return false;  // all of it fits
         const double factor = 10 * most + 10;
         liar.json["tolerance"] = factor * liar.tolerance_;
         for (Json& one : liar.json["rows"]) {
           for (Json& off : one["off"]) off = off.get<double>() / factor;
         }
         return true;
       }},
      {"another part",
       [](Liar& liar) {
         for (Json& curve : liar.json["curves"]) {
           if (curve["kind"] != "arc") continue;
           curve["numbers"][4] = -curve["numbers"][4].get<double>();
           return true;
         }
         return false;
       }},
      {"a tangent where it pivots",
       [](Liar& liar) {
         for (Json& one : liar.json["placements"]) {
           if (one["kind"] != "corner") continue;
           one["tangent"] = 0.123;
           return true;
         }
         return false;
       }},
      {"starts left out",
       [](Liar& liar) {
         Json& list = liar.json["rows"];
         if (list.size() < 3 || liar.json["closed"].get<bool>()) return false;
         const double left_out = liar.s_of(list[1]["start"]) - liar.s_of(list[0]["start"]);
         if (left_out < 1e-9 * liar.part_.perimeter()) return false;
         list.erase(0);
         return true;
       }},
  };
  return lies;
}

}  // namespace liar
