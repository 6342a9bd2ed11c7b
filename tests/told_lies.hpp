#pragma once

#include <cstddef>
#include <functional>
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <vector>

// What is alike in all lies about certificates: from one that is true, others that are not, each with a name.
namespace told_lies {

using Json = nlohmann::json;

/// A certificate that becomes a lie, by chance.
struct Document {
  Json& json;
  std::mt19937_64& generator;

  std::size_t index_in(const Json& list) {
    return std::uniform_int_distribution<std::size_t>(0, list.size() - 1)(generator);
  }
  Json& any(Json& list) { return list[index_in(list)]; }
  double sign() { return std::uniform_real_distribution<double>(-1, 1)(generator) < 0 ? -1 : 1; }
  double perimeter() const { return json["perimeter"].get<double>(); }

  static void add(Json& number, double by) { number = number.get<double>() + by; }
  static void scale(Json& number, double by) { number = number.get<double>() * by; }
};

/// `Told`: a Document that knows its format.
template <class Told>
struct Lie {
  std::string name;
  std::function<bool(Told&)> tell;  // false: there is nothing to lie about
};

template <class Told>
std::vector<Lie<Told>> about_the_outline() {
  return {
      {"face up for face down",
       [](Told& d) {
         d.json["mirrored"] = !d.json["mirrored"].template get<bool>();
         return true;
       }},
      {"another perimeter",
       [](Told& d) {
         Document::scale(d.json["perimeter"], 1.001);
         return true;
       }},
      {"a curve left out",
       [](Told& d) {
         d.json["curves"].erase(d.json["curves"].size() - 1);
         return !d.json["curves"].empty();
       }},
  };
}

/// Tells each of these lies about one certificate, and counts it; `expect_unproved(lie, name)`. `known`: what the one
/// who tells them has to know besides.
template <class Told, class Expect, class... Known>
void tell_each(const std::vector<Lie<Told>>& lies, const Json& truth, std::mt19937_64& generator,
               std::vector<int>& told, const Expect& expect_unproved, const Known&... known) {
  told.resize(lies.size());
  for (std::size_t k = 0; k < lies.size(); ++k) {
    Json json = truth;
    Told document{{json, generator}, known...};
    if (!lies[k].tell(document)) continue;
    ++told[k];
    expect_unproved(json, lies[k].name);
  }
}

template <class Told>
std::vector<Lie<Told>> together(std::vector<Lie<Told>> lies, const std::vector<Lie<Told>>& more) {
  lies.insert(lies.end(), more.begin(), more.end());
  return lies;
}

}  // namespace told_lies
