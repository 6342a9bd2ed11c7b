#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "certify/places.hpp"
#include "random_outlines.hpp"
#include "rollfix/part.hpp"

// Lies about one finger's answers, told by one who knows the format: from a certificate that is true, one that is not,
// with all that belongs together changed together.
namespace liar {

using Json = nlohmann::json;
using random_outlines::uniform;
using rollfix::Part;
using rollfix::Reading;

class Liar {
 public:
  Liar(const random_outlines::Question& question, Json truth, std::mt19937_64& generator)
      : part_(question.part),
        readings_(question.readings),
        tolerance_(question.tolerance),
        truth_(std::move(truth)),
        generator_(generator) {}

  struct Lie {
    std::string name;
    std::function<bool(Liar&, Json&)> tell;  // false: there is nothing to lie about
  };
  static const std::vector<Lie>& all();

  /// Nothing where this lie can't be told of this certificate.
  std::optional<Json> told(const Lie& lie) {
    Json document = truth_;
    return lie.tell(*this, document) ? std::optional<Json>(std::move(document)) : std::nullopt;
  }

 private:
  std::size_t any(std::size_t count) { return std::uniform_int_distribution<std::size_t>(0, count - 1)(generator_); }

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
    const auto& curves = truth_["curves"];
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
  static std::vector<std::size_t> cells(const Json& document, bool apart) {
    std::vector<std::size_t> result;
    const Json& rows = document["rows"];
    for (std::size_t k = 0; k < rows.size(); ++k) {
      if (rows[k].contains("then") && (rows[k]["then"] == "apart") == apart) result.push_back(k);
    }
    return result;
  }

  /// A start in the middle of a cell that is apart, with rows on both sides; the number of that cell.
  bool gap(const Json& document, std::size_t& cell, double& s, double& width) {
    std::vector<std::size_t> wide;
    for (const std::size_t k : cells(document, true)) {
      if (k + 1 >= document["rows"].size()) continue;
      const double lo = s_of(document["rows"][k]["start"]);
      const double hi = s_of(document["rows"][k + 1]["start"]);
      if (hi - lo > 1e-3 * part_.perimeter() && misses(lo + 0.5 * (hi - lo))) wide.push_back(k);
    }
    if (wide.empty()) return false;
    cell = wide[any(wide.size())];
    const double lo = s_of(document["rows"][cell]["start"]);
    width = s_of(document["rows"][cell + 1]["start"]) - lo;
    s = lo + 0.5 * width;
    return true;
  }

  bool invent(Json& document, const std::string& then, const std::string& kind) {
    std::size_t cell = 0;
    double s = 0;
    double width = 0;
    if (!gap(document, cell, s, width)) return false;
    const Json by = document["rows"][cell].value("by", Json());
    Json& rows = document["rows"];
    const Json before = row(s - 0.1 * width, then, readings_.size() > 1 ? Json{0} : Json());
    const auto at = rows.begin() + static_cast<std::ptrdiff_t>(cell) + 1;
    rows.insert(rows.insert(at, row(s + 0.1 * width, "apart", by)), before);
    document["placements"].push_back(placement(s, kind));
    return true;
  }

  bool invent_at_corner(Json& document, bool concave, const std::string& then) {
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
      Json& rows = document["rows"];
      std::size_t k = 0;
      while (k < rows.size() && s_of(rows[k]["start"]) < corner.s) ++k;
      if (k == 0 || k == rows.size() || rows[k - 1]["then"] != "apart") continue;
      const bool is_clear =
          s_of(rows[k - 1]["start"]) < corner.s - 2 * beside && s_of(rows[k]["start"]) > corner.s + 2 * beside;
      if (!is_clear) continue;
      const auto at = rows.begin() + static_cast<std::ptrdiff_t>(k);
      rows.insert(rows.insert(at, row(corner.s + beside, "apart")), row(corner.s - beside, then));
      document["placements"].push_back(placement(corner.s, "corner"));
      return true;
    }
    return false;
  }

  /// The cells of two placements next to each other made one, the second placement left out.
  bool merge(Json& document, const std::string& then) {
    const std::vector<std::size_t> own = cells(document, false);
    if (document["placements"].size() < 2 || own.size() != document["placements"].size()) return false;
    const std::size_t k = any(own.size() - 1);
    Json& rows = document["rows"];
    if (!then.empty()) rows[own[k]]["then"] = then;
    for (std::size_t i = own[k] + 1; i <= own[k + 1]; ++i) rows.erase(own[k] + 1);
    const double lo = s_of(rows[own[k]]["start"]);
    const double hi = own[k] + 1 < rows.size() ? s_of(rows[own[k] + 1]["start"]) : part_.perimeter();
    Json kept = Json::array();
    int inside = 0;
    for (const Json& one : document["placements"]) {
      const double s = s_of(one["at"]);
      if (s < lo || s > hi || inside++ == 0) kept.push_back(one);
    }
    if (kept.size() == document["placements"].size()) return false;
    document["placements"] = kept;
    return true;
  }

  bool one_round_all(Json& document, const std::string& then) {
    if (document["placements"].size() < 2 || !part_.closed()) return false;
    Json first = document["rows"][0];
    first["then"] = then;
    first.erase("by");
    document["rows"] = Json::array({first});
    document["placements"] = Json::array({document["placements"][any(document["placements"].size())]});
    return true;
  }

  bool move(Json& document, double share, bool with_rows) {
    Json& all = document["placements"];
    if (all.empty()) return false;
    Json& one = all[any(all.size())];
    const double s = s_of(one["at"]);
    const double to = s + share * part_.perimeter();
    if (to < 0 || to > part_.perimeter() || !misses(to)) return false;
    if (!part_.closed() && (to + readings_.back().length[0] < 0 || to + readings_.back().length[0] > part_.perimeter()))
      return false;
    one = placement(to, one["kind"]);
    if (!with_rows) return true;
    for (Json& other : document["rows"]) {
      const double from = s_of(other["start"]);
      if (std::abs(from - s) > 0.5 * std::abs(share) * part_.perimeter()) continue;
      other = row(from + to - s, other.value("then", Json()), other.value("by", Json()));
    }
    return true;
  }

  /// The row from which a placement's cell goes: the last one for what comes before the first one.
  std::size_t cell_of(const Json& document, const Json& placement) const {
    const Json& rows = document["rows"];
    std::size_t k = rows.size();
    while (k > 0 && s_of(rows[k - 1]["start"]) > s_of(placement["at"])) --k;
    return k == 0 ? rows.size() - 1 : k - 1;
  }

  bool change_kind(Json& document, const std::string& from, const std::string& to, const std::string& then) {
    if (readings_.size() > 1) return false;
    Json& all = document["placements"];
    if (cells(document, false).size() != all.size()) return false;
    for (std::size_t k = 0; k < all.size(); ++k) {
      if (all[k]["kind"] != from) continue;
      const std::size_t cell = cell_of(document, all[k]);
      if (from == "crossing" && document["rows"][cell]["then"] != "crossing") continue;
      if (from == "crossing" && to == "corner" && !misses(s_of(all[k]["at"]) + 1e-5 * part_.perimeter())) continue;
      all[k] = placement(s_of(all[k]["at"]), to);
      if (!then.empty()) document["rows"][cell]["then"] = then;
      return true;
    }
    return false;
  }

  /// All rows again, for another question.
  void renew(Json& document) const {
    for (Json& one : document["rows"])
      one = row(s_of(one["start"]), one.value("then", Json()), one.value("by", Json()));
    for (std::size_t k = 0; k < readings_.size(); ++k) {
      document["readings"][k] = {{"length", readings_[k].length[0]}, {"turn", readings_[k].turn}};
    }
  }

  bool other_question(Json& document, double by_turn, double by_length) {
    if (document["placements"].empty()) return false;
    const std::vector<Reading> before = readings_;
    const std::size_t k = any(readings_.size());
    readings_[k].turn += by_turn;
    readings_[k].length[0] += by_length * part_.perimeter();
    bool is_lie = part_.closed() || by_length == 0;
    if (is_lie) {
      is_lie = false;
      for (Json& one : document["placements"]) {
        const double s = s_of(one["at"]);
        is_lie = is_lie || misses(s);
        one = placement(s, one["kind"]);
      }
      renew(document);
    }
    readings_ = before;
    return is_lie;
  }

  Part part_;
  std::vector<Reading> readings_;
  double tolerance_;
  Json truth_;
  std::mt19937_64& generator_;
};

inline const std::vector<Liar::Lie>& Liar::all() {
  const auto invented = [](const char* then, const char* kind) {
    return [=](Liar& liar, Json& json) { return liar.invent(json, then, kind); };
  };
  const auto merged = [](const char* then) { return [=](Liar& liar, Json& json) { return liar.merge(json, then); }; };
  const auto round = [](const char* then) {
    return [=](Liar& liar, Json& json) { return liar.one_round_all(json, then); };
  };
  const auto moved = [](double share, bool rows) {
    return [=](Liar& liar, Json& json) { return liar.move(json, share, rows); };
  };
  const auto kind = [](const char* from, const char* to, const char* then) {
    return [=](Liar& liar, Json& json) { return liar.change_kind(json, from, to, then); };
  };
  const auto asked = [](double turn, double length) {
    return [=](Liar& liar, Json& json) { return liar.other_question(json, turn, length); };
  };
  const auto at_corner = [](bool concave, const char* then) {
    return [=](Liar& liar, Json& json) { return liar.invent_at_corner(json, concave, then); };
  };
  const auto on_placement = [](const std::function<void(Liar&, Json&)>& change) {
    return [=](Liar& liar, Json& json) {
      Json& list = json["placements"];
      if (list.empty()) return false;
      change(liar, list[liar.any(list.size())]);
      return true;
    };
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
      {"a kind that is not", on_placement([](Liar&, Json& one) { one["kind"] = "banana"; })},
      {"another turn", asked(0.05, 0)},
      {"a whole turn more", asked(2 * shapes::kPi, 0)},
      {"another length", asked(0, 0.03)},
      {"a lap more, its turn not", asked(0, 1)},
      {"a facing of too many digits",
       [](Liar&, Json& json) {
         json["readings"][0]["turn"] = 1e20;
         return true;
       }},
      {"all excluded",
       [](Liar& liar, Json& json) {
         if (json["placements"].empty()) return false;
         for (Json& one : json["rows"]) {
           if (one.contains("then")) one["then"] = "apart";
           if (one.contains("then") && liar.readings_.size() > 1) one["by"] = {0};
         }
         json["placements"] = Json::array();
         return true;
       }},
      {"one of them twice",
       [](Liar& liar, Json& json) {
         Json& list = json["placements"];
         if (list.empty()) return false;
         list.push_back(list[liar.any(list.size())]);
         return true;
       }},
      {"one left out",
       [](Liar& liar, Json& json) {
         Json& list = json["placements"];
         if (list.empty()) return false;
         list.erase(liar.any(list.size()));
         return true;
       }},
      {"an open one said to be closed",
       [](Liar& liar, Json& json) {
         if (liar.part_.closed()) return false;
         const rollfix::Vec2 first = liar.part_.point(0);
         const rollfix::Vec2 last = liar.part_.point(liar.part_.perimeter());
         json["closed"] = true;
         json["gap"] = (last - first).norm();
         json["rows"].back()["then"] = "unproved";
         return true;
       }},
      {"a wider tolerance",
       [](Liar& liar, Json& json) {
         if (json["placements"].empty()) return false;
         double most = 0;
         for (const Json& one : json["rows"]) {
           for (const Json& off : one["off"]) most = std::max(most, std::abs(off.get<double>()));
         }
         if (most < 1e3) return false;  // all of it fits
         const double factor = 10 * most + 10;
         json["tolerance"] = factor * liar.tolerance_;
         for (Json& one : json["rows"]) {
           for (Json& off : one["off"]) off = off.get<double>() / factor;
         }
         return true;
       }},
      {"another part",
       [](Liar&, Json& json) {
         for (Json& curve : json["curves"]) {
           if (curve["kind"] != "arc") continue;
           curve["numbers"][4] = -curve["numbers"][4].get<double>();
           return true;
         }
         return false;
       }},
      {"a tangent where it pivots",
       [](Liar&, Json& json) {
         for (Json& one : json["placements"]) {
           if (one["kind"] != "corner") continue;
           one["tangent"] = 0.123;
           return true;
         }
         return false;
       }},
      {"starts left out",
       [](Liar& liar, Json& json) {
         Json& list = json["rows"];
         if (list.size() < 3 || json["closed"].get<bool>()) return false;
         const double left_out = liar.s_of(list[1]["start"]) - liar.s_of(list[0]["start"]);
         if (left_out < 1e-9 * liar.part_.perimeter()) return false;
         list.erase(0);
         return true;
       }},
  };
  return lies;
}

}  // namespace liar
