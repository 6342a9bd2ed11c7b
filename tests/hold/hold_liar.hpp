#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "hold/hold_certificates.hpp"
#include "told_lies.hpp"

// Lies about holds, told by one who knows the format: from a certificate that is true, one that is not.
namespace hold_liar {

using hold_certificates::Json;
using touch_cases::uniform;

struct Document : told_lies::Document {
  Json& any_set() { return any(json["sets"]); }
  Json& any_lie() { return any(any_set()["instants"]); }
  Json& any_instant() { return any(json["instants"]); }
  bool has_wheel() const { return !json["wheels"].empty(); }
  bool has_encoder() const { return has_wheel() && !json["wheels"][0]["tolerance"]["spin"].is_null(); }
  bool has_place() const { return !json["fingers"][0]["tolerance"]["place"].is_null(); }
  /// Of a length.
  double tolerance() const {
    return has_place() ? json["fingers"][0]["tolerance"]["place"].get<double>() : 0.01 * perimeter();
  }

  /// Some contact or pin is off, so that the tolerance of lengths is tied to it.
  bool is_any_off() const {
    for (const Json& set : json["sets"]) {
      for (const Json& lie : set["instants"]) {
        if (lie["contacts"][0]["off"][0].get<double>() > 1e-3) return true;
      }
    }
    return false;
  }
};

using Lie = told_lies::Lie<Document>;

inline std::vector<Lie> about_sets() {
  return {
      {"a set left out, so that the first contacts are fewer",
       [](Document& d) {
         d.json["sets"].erase(d.index_in(d.json["sets"]));
         return true;
       }},
      {"all sets left out",
       [](Document& d) {
         d.json["sets"] = Json::array();
         return true;
       }},
      {"an extent that ends before its first contacts",
       [](Document& d) {
         Json& set = d.any_set();
         Json& arc = set["extent"][0];
         const double width = arc[1].get<double>() - arc[0].get<double>();
         if (width > 0.4 * d.perimeter()) return false;
         const double s = set["first"][0]["s"];
         const double past = s < arc[0].get<double>() - 1e-9 ? s + d.perimeter() : s;
         const double by = 1e-3 * std::max(width, 1e-5 * d.perimeter());
         if (past - by < arc[0].get<double>()) return false;
         arc[1] = past - by;
         return true;
       }},
      {"a set elsewhere, with all that is in it",
       [](Document& d) {
         Json& arc = d.any_set()["extent"][0];
         const double width = arc[1].get<double>() - arc[0].get<double>();
         if (width > 0.4 * d.perimeter() || arc[0].get<double>() < 1.1 * width + 1e-6) return false;
         for (Json& end : arc) Document::add(end, -1.1 * width);
         return true;
       }},
      {"a set of nothing, elsewhere, in place of one",
       [](Document& d) {
         if (d.json["sets"].size() > 1) return false;
         Json& set = d.any_set();
         for (Json& arc : set["extent"]) {
           if (arc[1].get<double>() - arc[0].get<double>() > 0.2 * d.perimeter()) return false;
           const double to = std::fmod(arc[0].get<double>() + 0.5 * d.perimeter(), d.perimeter());
           arc = {to, std::min(to + 0.1 * d.perimeter(), 1.05 * d.perimeter())};
         }
         for (const char* key : {"first", "zeros", "instants"}) set.erase(key);
         return true;
       }},
      {"extents the wrong way round",
       [](Document& d) {
         Json& arc = d.any_set()["extent"][0];
         std::swap(arc[0], arc[1]);
         return arc[0] != arc[1];
       }},
      {"a set that nothing is known of",
       [](Document& d) {
         Json& set = d.any_set();
         return set["listed"].get<bool>() && set.erase("first") > 0;
       }},
      {"first contacts that are elsewhere",
       [](Document& d) {
         Document::add(d.any_set()["first"][0]["s"], d.sign() * 1e-6 * d.perimeter());
         return true;
       }},
      {"first contacts by another parameter",
       [](Document& d) {
         Document::scale(d.any_set()["first"][0]["at"][1], 0.999);
         return true;
       }},
      {"a pose out of reach of the contacts",
       [](Document& d) {
         if (!d.has_place()) return false;
         Document::add(d.any_lie()["pose"][0], d.sign() * 3 * d.tolerance());
         return true;
       }},
      {"a pose moved by half a tolerance, as if it fitted as well",
       [](Document& d) {
         if (!d.has_place()) return false;
         Document::add(d.any_lie()["pose"][1], d.sign() * 0.5 * d.tolerance());
         return true;
       }},
      {"a pose turned",
       [](Document& d) {
         Document::add(d.any_lie()["pose"][2], d.sign() * uniform(d.generator, 0.5, 3));
         return true;
       }},
      {"the pose of another instant",
       [](Document& d) {
         Json& lies = d.any_set()["instants"];
         if (!d.has_place() || lies[0]["pose"] == lies.back()["pose"]) return false;
         std::swap(lies[0], lies[lies.size() - 1]);
         return true;
       }},
      {"an instant at which nothing is said",
       [](Document& d) {
         Json& lies = d.any_set()["instants"];
         lies.erase(lies.size() - 1);
         return true;
       }},
      {"a contact that fits better than it does",
       [](Document& d) {
         Document::add(d.any_lie()["contacts"][0]["off"][d.has_place() ? 0 : 1], 0.01);
         return true;
       }},
      {"a wheel that touches elsewhere",
       [](Document& d) {
         if (!d.has_wheel()) return false;
         Json& at = d.any_lie()["pins"][0]["at"];
         Document::scale(at[1], 0.9);
         return at[1].get<double>() != 0;
       }},
      {"a wheel with another tangent",
       [](Document& d) {
         if (!d.has_wheel()) return false;
         Document::add(d.any_lie()["pins"][0]["tangent"], uniform(d.generator, 2, 4));
         return true;
       }},
      {"a pin that fits better than it does",
       [](Document& d) {
         if (!d.has_wheel()) return false;
         Document::add(d.any_lie()["pins"][0]["off"][0], 0.01);
         return true;
       }},
      {"another zero of the encoder",
       [](Document& d) {
         if (!d.has_encoder()) return false;
         Document::add(d.any_set()["zeros"][0], 3 * d.json["wheels"][0]["tolerance"]["spin"].get<double>());
         return true;
       }},
  };
}

inline std::vector<Lie> about_the_question() {
  return {
      {"a pin elsewhere",
       [](Document& d) {
         if (!d.has_wheel()) return false;
         Document::add(d.any_instant()["pins"][0]["at"][0], d.sign() * 3 * d.tolerance());
         return true;
       }},
      {"the pin of another row",
       [](Document& d) {
         Json& instants = d.json["instants"];
         if (!d.has_wheel() || instants[0]["pins"] == instants.back()["pins"]) return false;
         std::swap(instants[0]["pins"], instants[instants.size() - 1]["pins"]);
         return true;
       }},
      {"the contact of another row",
       [](Document& d) {
         Json& instants = d.json["instants"];
         Json& last = instants[instants.size() - 1]["contacts"][0];
         const double travelled = last["travelled"].get<double>();
         if (std::abs(travelled) < 0.02 * d.perimeter() && !d.has_place()) return false;
         std::swap(instants[0]["contacts"][0], last);
         return true;
       }},
      {"a contact elsewhere",
       [](Document& d) {
         if (!d.has_place()) return false;
         Document::add(d.any_instant()["contacts"][0]["at"][1], d.sign() * 3 * d.tolerance());
         return true;
       }},
      {"a tangent turned",
       [](Document& d) {
         Document::add(d.any_instant()["contacts"][0]["tangent"], d.sign() * uniform(d.generator, 1.5, 3));
         return true;
       }},
      {"another way travelled",
       [](Document& d) {
         if (!d.has_place()) return false;
         Document::add(d.any_instant()["contacts"][0]["travelled"], d.sign() * 3 * d.tolerance());
         return true;
       }},
      {"an encoder that turned otherwise",
       [](Document& d) {
         if (!d.has_encoder()) return false;
         Document::add(d.any_instant()["pins"][0]["spin"], 3 * d.json["wheels"][0]["tolerance"]["spin"].get<double>());
         return true;
       }},
      {"another radius of the wheel",
       [](Document& d) {
         if (!d.has_wheel()) return false;
         Document::add(d.json["wheels"][0]["radius"], 0.5 * d.tolerance());
         return true;
       }},
      {"a wheel's radius below 0",
       [](Document& d) {
         if (!d.has_wheel()) return false;
         d.json["wheels"][0]["radius"] = -d.tolerance();
         return true;
       }},
      {"a wheel too few",
       [](Document& d) {
         if (!d.has_wheel()) return false;
         d.json["wheels"].erase(d.json["wheels"].size() - 1);
         return true;
       }},
      {"a wider tolerance",
       [](Document& d) {
         if (!d.is_any_off()) return false;
         for (Json& finger : d.json["fingers"]) Document::scale(finger["tolerance"]["place"], 1.2);
         return true;
       }},
      {"a narrower tolerance",
       [](Document& d) {
         if (!d.is_any_off()) return false;
         for (Json& finger : d.json["fingers"]) Document::scale(finger["tolerance"]["place"], 0.8);
         return true;
       }},
      {"tolerances that are all wider, and no set that is",
       [](Document& d) {
         for (const Json& set : d.json["sets"]) {
           for (const Json& arc : set["extent"]) {
             if (arc[1].get<double>() - arc[0].get<double>() > 0.02 * d.perimeter()) return false;
           }
         }
         for (const char* list : {"fingers", "wheels"}) {
           for (Json& one : d.json[list]) {
             for (Json& tolerance : one["tolerance"]) {
               if (!tolerance.is_null()) Document::scale(tolerance, 8);
             }
           }
         }
         // All residuals are said anew, so that only what is left out can tell.
         for (Json& set : d.json["sets"]) {
           for (Json& lie : set["instants"]) {
             for (const char* list : {"contacts", "pins"}) {
               for (Json& one : lie[list]) {
                 for (Json& off : one["off"]) Document::scale(off, 0.125);
               }
             }
           }
         }
         return true;
       }},
      {"a tolerance of nothing",
       [](Document& d) {
         d.json["fingers"][0]["tolerance"]["angle"] = 1e-14;
         return true;
       }},
      {"a reach of nothing, which leaves no first contacts",
       [](Document& d) {
         if (d.json["fingers"][0]["kind"] == "outline") return false;
         d.json["fingers"][0]["reach"] = {{"arcs", Json::array()}, {"corners", Json::array()}};
         d.json["sets"] = Json::array();
         return true;
       }},
      {"a reach without the place of a first contact",
       [](Document& d) {
         const double s = d.any_set()["first"][0]["s"];
         const double by = 1e-3 * d.perimeter();
         if (!d.json["fingers"][0]["reach"].is_null() || s + by > d.perimeter() || s < by) return false;
         d.json["fingers"][0]["reach"] = {{"arcs", {{0.0, s - by}, {s + by, d.perimeter()}}},
                                          {"corners", Json::array()}};
         d.json["sets"] = Json::array();
         return true;
       }},
      {"a wheel's reach of nothing",
       [](Document& d) {
         if (!d.has_wheel()) return false;
         d.json["wheels"][0]["reach"] = {{"arcs", {{0.0, 1e-3 * d.perimeter()}}}, {"corners", Json::array()}};
         d.json["sets"] = Json::array();
         return true;
       }},
      {"no fingers",
       [](Document& d) {
         d.json["fingers"] = Json::array();
         return true;
       }},
      {"no instants",
       [](Document& d) {
         d.json["instants"] = Json::array();
         return true;
       }},
      {"all that is left open",
       [](Document& d) {
         Json all = Json::array();
         for (std::size_t k = 0; k < d.json["fingers"].size(); ++k) all.push_back({0.0, d.perimeter()});
         d.json["sets"] = Json::array();
         d.json["unresolved"] = Json::array({all});
         return true;
       }},
      {"another outline",
       [](Document& d) {
         Json& numbers = d.any(d.json["curves"])["numbers"];
         Document::scale(numbers[0], 1.01);
         return numbers[0].get<double>() != 0;
       }},
      {"a number that is none",
       [](Document& d) {
         d.any_lie()["pose"][2] = nullptr;
         return true;
       }},
  };
}

inline std::vector<Lie> all() {
  return told_lies::together(told_lies::together(about_sets(), about_the_question()),
                             told_lies::about_the_outline<Document>());
}

/// How often each kind was told, of rigs and of three and more fingers; none of them may be proved.
template <class Expect>
std::vector<int> tell(int questions, std::mt19937_64& generator, const Expect& expect_unproved) {
  const std::vector<Lie> lies = all();
  std::vector<int> told(lies.size(), 0);
  for (int k = 0; k < questions; ++k) {
    const Json truth =
        hold_certificates::certificate(k % 3 < 2 ? hold_certificates::random_rig_question(k, generator)
                                                 : hold_certificates::random_hold_question(k / 3, generator));
    const auto has_first = [](const Json& one) { return one.contains("first"); };
    if (truth["sets"].empty() || !std::all_of(truth["sets"].begin(), truth["sets"].end(), has_first)) continue;
    told_lies::tell_each(lies, truth, generator, told,
                         [&](const Json& lie, const std::string& name) { expect_unproved(lie, name, k); });
  }
  return told;
}

}  // namespace hold_liar
