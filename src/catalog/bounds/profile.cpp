#include "profile.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "files/byte_stream.hpp"
#include "part/turning_range.hpp"
#include "rounding.hpp"

// Notation:
//   Theta           the tangent's angle; P the perimeter, cell k is [k P / N, (k + 1) P / N]
//   least, most     of Theta on each cell, in single precision, rounded outwards
//   step            a 255th of the range of a cell of 64: a bound of a cell of 256 is a number of these, rounded
//                   outwards
// Follows docs/identify.md, "How parts are ruled out" and the table of the file's columns.
// Idea: covers, not samples. Joints beside a cell's end are in both cells (`kBeyondCell`), so that rounding of places
// loses nothing, and four cells of a finer profile make one of the coarser.
namespace rollfix {
namespace {

// Joints may be on either side of a cell's end by rounding: cells are looked at this share of them farther.
constexpr double kBeyondCell = 1e-6;
// Steps between the bounds of a cell of 64.
constexpr int kSteps = 255;

template <std::size_t N>
Profile<N / 4> quarter_of(const Profile<N>& fine) {
  Profile<N / 4> coarse;
  for (std::size_t k = 0; k < N / 4; ++k) {
    const float* const least = fine.least.data() + 4 * k;
    const float* const most = fine.most.data() + 4 * k;
    coarse.least[k] = *std::min_element(least, least + 4);
    coarse.most[k] = *std::max_element(most, most + 4);
  }
  return coarse;
}

std::string with_checksum(const std::string& bytes) {
  ByteWriter writer;
  writer.whole(checksum(bytes));
  return bytes + writer.bytes();
}

/// Without its checksum; nothing where the length or that is not as expected.
std::optional<std::string_view> checked(std::string_view bytes, std::size_t length) {
  if (bytes.size() != length + sizeof(std::uint64_t)) return std::nullopt;
  const std::string_view content = bytes.substr(0, length);
  if (ByteReader(bytes.substr(length)).whole() != checksum(content)) return std::nullopt;
  return content;
}

/// So many steps into the range of a cell of 64, from its lower end and from its upper one.
float up_from(float least, float most, int steps) {
  return least + static_cast<float>(steps) * ((most - least) / static_cast<float>(kSteps));
}
float down_from(float least, float most, int steps) {
  return most - static_cast<float>(steps) * ((most - least) / static_cast<float>(kSteps));
}

/// The most steps of which `is_outside` says that they don't go too far.
template <typename IsOutside>
char most_steps(double share, const IsOutside& is_outside) {
  int steps = std::isfinite(share) ? static_cast<int>(std::clamp(kSteps * share, 0.0, 1.0 * kSteps)) : 0;
  while (steps > 0 && !is_outside(steps)) --steps;
  return static_cast<char>(static_cast<unsigned char>(steps));
}

}  // namespace

Profile<kFineCells> profile_of(const Part& part) {
  Profile<kFineCells> profile;
  const double step = part.perimeter() / kFineCells;
  for (std::size_t k = 0; k < kFineCells; ++k) {
    const auto at = static_cast<double>(k);
    Interval arc{step * (at - kBeyondCell), step * (at + 1 + kBeyondCell)};
    if (!part.closed()) arc = {std::max(arc.lo, 0.0), std::min(arc.hi, part.perimeter())};
    const Interval angles = angles_over(part.turning(), arc);
    profile.least[k] = float_below(angles.lo);
    profile.most[k] = float_above(angles.hi);
  }
  return profile;
}

Profile<kCells> coarser(const Profile<kFineCells>& fine) { return quarter_of(fine); }
Profile<kCoarseCells> coarser(const Profile<kCells>& cells) { return quarter_of(cells); }

std::string bytes_of(const Profile<kCells>& profile) {
  ByteWriter bytes;
  for (const auto* bounds : {&profile.least, &profile.most}) {
    for (std::size_t k = 0; k < kCells; k += 2) {
      const auto first = std::bit_cast<std::uint32_t>((*bounds)[k]);
      const auto second = std::bit_cast<std::uint32_t>((*bounds)[k + 1]);
      bytes.whole(first | static_cast<std::uint64_t>(second) << 32U);
    }
  }
  return with_checksum(bytes.bytes());
}

std::optional<Profile<kCells>> profile_from(std::string_view bytes) {
  const std::optional<std::string_view> content = checked(bytes, 2 * kCells * sizeof(float));
  if (!content) return std::nullopt;
  Profile<kCells> profile;
  ByteReader reader(*content);
  for (auto* bounds : {&profile.least, &profile.most}) {
    for (std::size_t k = 0; k < kCells; k += 2) {
      const std::uint64_t both = reader.whole();
      (*bounds)[k] = std::bit_cast<float>(static_cast<std::uint32_t>(both));
      (*bounds)[k + 1] = std::bit_cast<float>(static_cast<std::uint32_t>(both >> 32U));
    }
  }
  return profile;
}

std::string fine_bytes_of(const Profile<kFineCells>& fine, const Profile<kCells>& cells) {
  std::string bytes(2 * kFineCells, '\0');
  for (std::size_t k = 0; k < kFineCells; ++k) {
    const float least = cells.least[k / 4];
    const float most = cells.most[k / 4];
    const double range = static_cast<double>(most) - least;
    bytes[k] = most_steps((fine.least[k] - least) / range,
                          [&](int steps) { return up_from(least, most, steps) <= fine.least[k]; });
    bytes[kFineCells + k] = most_steps((most - fine.most[k]) / range,
                                       [&](int steps) { return down_from(least, most, steps) >= fine.most[k]; });
  }
  return with_checksum(bytes);
}

std::optional<Profile<kFineCells>> fine_profile_from(std::string_view bytes, const Profile<kCells>& cells) {
  const std::optional<std::string_view> content = checked(bytes, 2 * kFineCells);
  if (!content) return std::nullopt;
  Profile<kFineCells> fine;
  const auto steps = [&](std::size_t k) { return static_cast<int>(static_cast<unsigned char>((*content)[k])); };
  for (std::size_t cell = 0; cell < kCells; ++cell) {
    const float least = cells.least[cell];
    const float most = cells.most[cell];
    for (std::size_t k = 4 * cell; k < 4 * cell + 4; ++k) {
      fine.least[k] = up_from(least, most, steps(k));
      fine.most[k] = down_from(least, most, steps(kFineCells + k));
    }
  }
  return fine;
}

}  // namespace rollfix
