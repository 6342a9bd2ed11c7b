#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <random>
#include <string>
#include <vector>

#include "told_lies.hpp"
#include "touch/touch_certificates.hpp"

// Lies about touches, told by one who knows the format: from a certificate that is true, one that is not, with what
// belongs together changed together.
namespace touch_liar {

using touch_cases::uniform;
using touch_certificates::Json;

struct Document : told_lies::Document {
  Json& any(const char* list) { return told_lies::Document::any(json[list]); }
  double tolerance() const {
    return json[json["touches"].empty() ? "rolls" : "touches"][0]["tolerance"][0].get<double>();
  }

  /// Some pose of its set with all contacts, whose set is no larger than it looks.
  Json* any_set() {
    for (std::size_t tries = 0; tries < 20; ++tries) {
      Json& pose = any("poses");
      if (pose.contains("extent")) return &pose;
    }
    return nullptr;
  }

  /// Some contact is off, so that the tolerance is tied to it; else another tolerance is another question.
  bool is_any_off() const {
    for (const Json& pose : json["poses"]) {
      for (const Json& contact : pose["contacts"]) {
        if (std::abs(contact["off"][0].get<double>()) > 1e-3) return true;
      }
    }
    return false;
  }

  /// Rewrites how far the contacts are off, in other tolerances.
  void rescale_off(double by) {
    for (Json& pose : json["poses"]) {
      for (Json& contact : pose["contacts"]) {
        for (Json& off : contact["off"]) scale(off, by);
      }
    }
  }
};

using Lie = told_lies::Lie<Document>;

inline std::vector<Lie> about_poses() {
  return {
      {"a set left out",
       [](Document& d) {
         if (d.any_set() == nullptr) return false;
         std::size_t k = d.index_in(d.json["poses"]);
         while (!d.json["poses"][k].contains("extent")) k = d.index_in(d.json["poses"]);
         // What another set holds as well need not be there.
         d.json["poses"].erase(k);
         return d.json["poses"].empty();
       }},
      {"all sets left out",
       [](Document& d) {
         d.json["poses"] = Json::array();
         return true;
       }},
      {"a pose said to be in another set",
       [](Document& d) {
         if (d.json["poses"].size() != 1) return false;
         return d.json["poses"][0].erase("extent") > 0;
       }},
      {"a set without a pose",
       [](Document& d) {
         Json& pose = d.any("poses");
         if (!pose["listed"].get<bool>()) return false;
         return pose.erase("pose") > 0;
       }},
      {"half of an extent",
       [](Document& d) {
         if (d.json["poses"].size() != 1) return false;
         Json& limits = d.json["poses"][0]["extent"][std::uniform_int_distribution<std::size_t>(0, 2)(d.generator)];
         const double middle = 0.5 * (limits[0].get<double>() + limits[1].get<double>());
         limits[d.sign() < 0 ? 0 : 1] = middle;
         return true;
       }},
      {"an extent elsewhere",
       [](Document& d) {
         Json* set = d.any_set();
         if (set == nullptr) return false;
         Json& limits = (*set)["extent"][0];
         const double by = limits[1].get<double>() - limits[0].get<double>() + d.tolerance();
         for (Json& limit : limits) Document::add(limit, by);
         return true;
       }},
      {"an extent's headings the wrong way round",
       [](Document& d) {
         Json* set = d.any_set();
         if (set == nullptr) return false;
         std::swap((*set)["extent"][2][0], (*set)["extent"][2][1]);
         return true;
       }},
      {"a pose moved out of reach of its contacts",
       [](Document& d) {
         Document::add(d.any("poses")["pose"][0], d.sign() * 3 * d.tolerance());
         return true;
       }},
      {"a pose moved by half a tolerance, as if it fitted as well",
       [](Document& d) {
         Document::add(d.any("poses")["pose"][1], d.sign() * 0.5 * d.tolerance());
         return true;
       }},
      {"a pose turned",
       [](Document& d) {
         Document::add(d.any("poses")["pose"][2], d.sign() * uniform(d.generator, 0.5, 3));
         return true;
       }},
      {"a pose with a contact too few",
       [](Document& d) {
         Json& contacts = d.any("poses")["contacts"];
         contacts.erase(contacts.size() - 1);
         return true;
       }},
      {"a contact at another place",
       [](Document& d) {
         Json& contact = d.any("poses")["contacts"][0];
         const Json& curve = contact["at"][0];
         contact["at"][0] = (curve.get<std::size_t>() + 1) % d.json["curves"].size();
         return d.json["curves"].size() > 1;
       }},
      {"a contact at another s",
       [](Document& d) {
         Document::add(d.any("poses")["contacts"][0]["s"], 0.1 * d.perimeter());
         return true;
       }},
      {"another tangent",
       [](Document& d) {
         Document::add(d.any("poses")["contacts"][0]["tangent"], uniform(d.generator, 2, 4));
         return true;
       }},
      {"a contact that fits better than it does",
       [](Document& d) {
         Document::add(d.any("poses")["contacts"][0]["off"][0], 0.01);
         return true;
       }},
  };
}

inline std::vector<Lie> about_the_question() {
  return {
      {"a touch elsewhere",
       [](Document& d) {
         Document::add(d.any("touches")["at"][0], d.sign() * 3 * d.tolerance());
         return true;
       }},
      {"a normal turned",
       [](Document& d) {
         Json& touch = d.any("touches");
         if (!touch.contains("normal")) return false;
         Document::add(touch["normal"], d.sign() * uniform(d.generator, 0.5, 3));
         return true;
       }},
      {"a wider tolerance",
       [](Document& d) {
         if (!d.is_any_off()) return false;
         for (Json& touch : d.json["touches"]) Document::scale(touch["tolerance"][0], 1.2);
         return true;
       }},
      {"a wider tolerance, all contacts said anew",
       [](Document& d) {
         for (Json& touch : d.json["touches"]) {
           for (Json& tolerance : touch["tolerance"]) Document::scale(tolerance, 4);
         }
         d.rescale_off(0.25);
         const Json& extent = d.json["poses"][0];  // all the plane is no lie
         return extent.contains("extent") && d.json["poses"].size() == 1 &&
                extent["extent"][2][1].get<double>() - extent["extent"][2][0].get<double>() < 1;
       }},
      {"a narrower tolerance",
       [](Document& d) {
         if (!d.is_any_off()) return false;
         for (Json& touch : d.json["touches"]) Document::scale(touch["tolerance"][0], 0.8);
         return true;
       }},
      {"a tolerance of nothing",
       [](Document& d) {
         d.any("touches")["tolerance"][0] = 1e-14;
         return true;
       }},
      {"another radius",
       [](Document& d) {
         Document::add(d.json["radius"], 0.5 * d.tolerance());
         return true;
       }},
      {"a radius below 0",
       [](Document& d) {
         d.json["radius"] = -d.tolerance();
         return true;
       }},
      {"a reach of nothing, which leaves no pose",
       [](Document& d) {
         d.json["reach"] = {{"arcs", Json::array()}, {"corners", Json::array()}};
         d.json["poses"] = Json::array();
         return true;
       }},
      {"a reach without the place of a contact",
       [](Document& d) {
         const double s = d.any("poses")["contacts"][0]["s"];
         const double perimeter = d.json["perimeter"];
         const double from = s + 1e-3 * perimeter;
         if (!d.json["reach"].is_null() || from > perimeter || s < 1e-3 * perimeter) return false;
         const double to = s - 1e-3 * perimeter;
         d.json["reach"] = {{"arcs", {{0.0, to}, {from, perimeter}}}, {"corners", Json::array()}};
         d.json["poses"] = Json::array();
         return true;
       }},
      {"an arc of the reach cut short",
       [](Document& d) {
         if (d.json["reach"].is_null() || d.json["reach"]["arcs"].empty()) return false;
         Json& arc = d.json["reach"]["arcs"][0];
         arc[0] = 0.5 * (arc[0].get<double>() + arc[1].get<double>());
         return true;
       }},
      {"a corner of the reach left out",
       [](Document& d) {
         if (d.json["reach"].is_null()) return false;
         bool has_any = false;
         for (Json& corner : d.json["reach"]["corners"]) {
           has_any = has_any || !corner["angles"].empty();
           corner["angles"] = Json::array();
         }
         return has_any;
       }},
      {"no touches",
       [](Document& d) {
         d.json["touches"] = Json::array();
         return true;
       }},
      {"a touch too few",
       [](Document& d) {
         d.json["touches"].erase(d.json["touches"].size() - 1);
         return true;
       }},
      {"all that is left open",
       [](Document& d) {
         d.json["poses"] = Json::array();
         d.json["unresolved"] = {{"touch", 0}, {"arcs", {{0.0, d.json["perimeter"]}}}};
         return true;
       }},
      {"what is left open is of no touch",
       [](Document& d) {
         d.json["unresolved"] = {{"touch", 99}, {"arcs", {{0.0, d.json["perimeter"]}}}};
         return true;
       }},
      // A closed one that is said to be open is another question: the verdict says which it is.
      {"a closed outline for an open one",
       [](Document& d) {
         if (d.json["closed"].get<bool>()) return false;
         d.json["closed"] = true;
         return true;
       }},
      {"another outline",
       [](Document& d) {
         Json& numbers = d.any("curves")["numbers"];
         if (numbers.size() < 4) return false;
         Document::add(numbers[0], 0.01 * d.perimeter());
         return true;
       }},
      {"a number that is none",
       [](Document& d) {
         d.any("poses")["pose"][0] = nullptr;
         return true;
       }},
  };
}

inline std::vector<Lie> all() {
  return told_lies::together(told_lies::together(about_poses(), about_the_question()),
                             told_lies::about_the_outline<Document>());
}

/// How often each kind was told, of parts of these kinds by turns; none of them may be proved.
template <class Expect>
std::vector<int> tell(int questions, const std::vector<int>& kinds, std::mt19937_64& generator,
                      const Expect& expect_unproved) {
  const std::vector<Lie> lies = all();
  std::vector<int> told(lies.size(), 0);
  for (int k = 0; k < questions; ++k) {
    const Json truth = touch_certificates::certificate(
        touch_certificates::random_question(kinds[static_cast<std::size_t>(k) % kinds.size()], generator));
    const auto has_pose = [](const Json& one) { return one.contains("pose"); };
    if (truth["poses"].empty() || !std::all_of(truth["poses"].begin(), truth["poses"].end(), has_pose)) continue;
    told_lies::tell_each(lies, truth, generator, told,
                         [&](const Json& lie, const std::string& name) { expect_unproved(lie, name, k); });
  }
  return told;
}

}  // namespace touch_liar
