#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "rollfix/identify.hpp"
#include "rollfix/part.hpp"
#include "rollfix/solve.hpp"

namespace rollfix::catalog {

// How parts are weighed against each other.

// A part that has less than exp(-this) of the likeliest one's weight is nothing: far less than is listed.
inline constexpr double kNothing = 20;

// Without noise tangents of parts that are the same differ by no more, radians.
inline constexpr double kSameTurn = 1e-7;

/// Of a part that something fits on.
PartWeight weight_of(std::size_t part, const Answer& answer);

/// The logarithm of a part's probability, up to what is the same for all.
double log_weight(const Catalog& catalog, const PartWeight& weight, double widened);

/// Whether some part explains the rows with the noise that was said.
bool fits_well(const std::vector<PartWeight>& weights);

/// The part that the rows fit best, with the noise that they seem to have there: all are weighed as with that. REQUIRES
/// that there is one.
const PartWeight& best_of(const std::vector<PartWeight>& weights);

/// What parts come to that were weighed.
struct Conclusion {
  std::vector<std::size_t> order;   // of the weights that are listed: the likeliest first, else as in the catalog
  std::vector<double> probability;  // of all weights; NaN without noise
  std::vector<std::vector<std::size_t>> congruent;  // of all: those of the listed that can't be told from it
  std::string verdict;
  Status status = Status::complete;
  double rest = 0;  // with noise: probability of all that is not listed
};

/// How far two parts may be apart that can't be told from each other by a roll.
struct Likeness {
  double length = 0;  // of places, besides what parts are as large as
  double turn = 0;    // of tangents, radians
  double roll = 0;    // the roll's length
  bool noisy = false;
};
Likeness likeness_of(const Problem& like);

/// How a verdict puts it.
struct Wording {
  std::string (*of_one)(const PartWeight&);  // what is known of the one part that is left: "unique place", ...
  const char* badly;                         // what is added where even the likeliest part fits badly
};
extern const Wording kOfRolls;

/// Weights of parts of this catalog as one verdict; so many parts were searched.
Conclusion conclude(const Catalog& catalog, const std::vector<PartWeight>& weights, std::size_t searched,
                    const Likeness& likeness, const Wording& wording = kOfRolls);

// Outlines that are the same are so to this share of the perimeter.
inline constexpr double kSameScale = 1e-9;

/// Whether two parts are the same outline as far as a roll can tell, seen from one of the places on each on.
bool are_congruent(const Part& one, const std::vector<double>& from, const Part& other,
                   const std::vector<double>& other_from, const Likeness& likeness);

}  // namespace rollfix::catalog
