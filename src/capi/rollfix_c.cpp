// The C interface (rollfix/rollfix.h) over the library: no exception leaves it.
#include "rollfix/rollfix.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <new>
#include <numbers>
#include <string>
#include <vector>

#include "capi/locator.hpp"
#include "rollfix/error.hpp"
#include "rollfix/files.hpp"
#include "rollfix/outline.hpp"
#include "rollfix/version.hpp"

struct rollfix_part {
  rollfix::Part part;
};

struct rollfix_locator {
  rollfix::capi::Locator locator;
  bool is_located = false;
};

namespace {

using rollfix::InputError;
using rollfix::Part;
using rollfix::Verdict;

void say(const char* what, char* message, std::size_t size) {
  if (message == nullptr || size == 0) return;
  const std::size_t length = std::min(std::strlen(what), size - 1);
  std::memcpy(message, what, length);
  message[length] = '\0';
}

/// Every exception as a code and a line.
template <class Work>
rollfix_code guarded(char* message, std::size_t size, const Work& work) {
  try {
    return work();
  } catch (const std::bad_alloc&) {
    say("out of memory", message, size);
    return ROLLFIX_MEMORY;
  } catch (const InputError& error) {
    say(error.what(), message, size);
    return ROLLFIX_INPUT;
  } catch (const std::exception& error) {
    say(error.what(), message, size);
    return ROLLFIX_INTERNAL;
  } catch (...) {
    say("an unknown error", message, size);
    return ROLLFIX_INTERNAL;
  }
}

/// What the caller knows of such a struct, and the defaults of the rest.
template <class Struct>
Struct known(const Struct* given, const Struct& defaults) {
  Struct all = defaults;
  if (given == nullptr) return all;
  if (given->struct_size < sizeof(std::size_t)) {
    throw InputError("struct_size: expected the struct's size, found less; take the struct from rollfix_default_...");
  }
  std::memcpy(&all, given, std::min(given->struct_size, sizeof(Struct)));
  all.struct_size = sizeof(Struct);
  return all;
}

/// A struct to fill in whose maker has said how large it is.
template <class Struct>
bool can_take(const Struct* to) {
  return to != nullptr && to->struct_size >= sizeof(std::size_t);
}

/// As many of the fields as the caller knows.
template <class Struct>
void give(Struct all, Struct* to) {
  const std::size_t size = std::min(to->struct_size, sizeof(Struct));
  all.struct_size = to->struct_size;
  std::memcpy(to, &all, size);
}

void require(const void* pointer, const char* name) {
  if (pointer == nullptr) throw InputError(fmt::format("{}: expected a pointer, found NULL", name));
}

rollfix::LoadOptions load_options(const rollfix_part_options& options) {
  rollfix::LoadOptions load;
  load.points.open = options.open != 0;
  if (options.corner_angle >= 0) load.points.corner_angle = options.corner_angle;
  load.allow_crossing = options.allow_crossing != 0;
  return load;
}

rollfix::Noise noise_of(const rollfix_options& options) {
  rollfix::Noise noise;
  noise.contact = options.distance;
  noise.angle = options.turn;
  noise.slip = options.slip;
  noise.gyro = options.gyro_scale;
  noise.drift = options.gyro_bias;
  noise.walk = options.gyro_walk;
  return noise;
}

rollfix_verdict verdict_of(const Verdict& verdict) {
  switch (verdict.name) {
    case Verdict::unique:
      return ROLLFIX_UNIQUE;
    case Verdict::ambiguous:
      return ROLLFIX_AMBIGUOUS;
    case Verdict::unobservable:
      return ROLLFIX_UNOBSERVABLE;
    case Verdict::inconsistent:
      return ROLLFIX_INCONSISTENT;
    case Verdict::undecided:
      break;
  }
  return ROLLFIX_UNDECIDED;
}

}  // namespace

int32_t rollfix_abi() { return ROLLFIX_ABI; }
const char* rollfix_version() { return rollfix::kVersion; }

rollfix_part_options rollfix_default_part_options() { return {sizeof(rollfix_part_options), 0, 0, -1}; }
rollfix_options rollfix_default_options() { return {sizeof(rollfix_options), 0, 0, 0, 0, 0, 0, 0}; }

rollfix_code rollfix_part_from_points(const double* xy, size_t points, const rollfix_part_options* options,
                                      rollfix_part** part, char* message, size_t size) {
  return guarded(message, size, [&] {
    require(xy, "xy");
    require(part, "part");
    const rollfix_part_options all = known(options, rollfix_default_part_options());
    std::vector<rollfix::Vec2> places;
    for (std::size_t k = 0; k < points; ++k) places.emplace_back(xy[2 * k], xy[2 * k + 1]);
    const rollfix::LoadOptions load = load_options(all);
    *part = new rollfix_part{Part(rollfix::outline_through(places, "the points", load.points), {load.allow_crossing})};
    return ROLLFIX_OK;
  });
}

rollfix_code rollfix_part_load(const char* path, const rollfix_part_options* options, rollfix_part** part,
                               char* message, size_t size) {
  return guarded(message, size, [&] {
    require(path, "path");
    require(part, "part");
    const rollfix_part_options all = known(options, rollfix_default_part_options());
    *part = new rollfix_part{rollfix::load_part(path, load_options(all)).part};
    return ROLLFIX_OK;
  });
}

void rollfix_part_free(rollfix_part* part) { delete part; }

double rollfix_part_length(const rollfix_part* part) { return part == nullptr ? 0 : part->part.perimeter(); }
int32_t rollfix_part_reversed(const rollfix_part* part) { return part != nullptr && part->part.reversed() ? 1 : 0; }

rollfix_code rollfix_start(const rollfix_part* part, const rollfix_options* options, rollfix_locator** locator,
                           char* message, size_t size) {
  return guarded(message, size, [&] {
    require(part, "part");
    require(options, "options");
    require(locator, "locator");
    const rollfix_options all = known(options, rollfix_default_options());
    *locator = new rollfix_locator{{part->part, noise_of(all), all.points}};
    return ROLLFIX_OK;
  });
}

void rollfix_stop(rollfix_locator* locator) { delete locator; }

size_t rollfix_bytes(const rollfix_locator* locator) { return locator == nullptr ? 0 : locator->locator.bytes(); }

rollfix_code rollfix_push(rollfix_locator* locator, double seconds, double distance, double turn) {
  if (locator == nullptr || locator->locator.refusal(seconds, distance, turn) != nullptr) return ROLLFIX_INPUT;
  if (locator->locator.is_used_up()) return ROLLFIX_MEMORY;
  return guarded(nullptr, 0, [&] {
    locator->locator.push(seconds, distance, turn);
    return ROLLFIX_OK;
  });
}

rollfix_code rollfix_locate(rollfix_locator* handle, rollfix_answer* answer) {
  if (handle == nullptr || !can_take(answer)) return ROLLFIX_INPUT;
  rollfix::capi::Locator& locator = handle->locator;
  if (locator.is_used_up()) return ROLLFIX_MEMORY;
  if (locator.rows() == 0) return ROLLFIX_NOTHING;
  handle->is_located = false;
  return guarded(nullptr, 0, [&] {
    locator.locate();
    handle->is_located = true;
    const rollfix::Fit& fit = locator.fit();
    const rollfix_answer all{sizeof(rollfix_answer),
                             verdict_of(locator.verdict()),
                             fit.is_bad() ? 1 : 0,
                             locator.rows(),
                             locator.modes().size(),
                             locator.rest(),
                             fit.excess,
                             fit.length_scale[0],
                             fit.length_scale_sd[0],
                             fit.turn_scale,
                             fit.turn_scale_sd,
                             fit.turn_bias,
                             fit.turn_bias_sd};
    give(all, answer);
    return ROLLFIX_OK;
  });
}

rollfix_code rollfix_place_at(const rollfix_locator* handle, size_t index, rollfix_place* place) {
  if (handle == nullptr || !can_take(place)) return ROLLFIX_INPUT;
  const rollfix::capi::Locator& locator = handle->locator;
  if (!handle->is_located || index >= locator.modes().size()) return ROLLFIX_NOTHING;
  return guarded(nullptr, 0, [&] {
    const rollfix::Mode& mode = locator.modes()[index];
    const Part& part = locator.part();
    const double now = mode.end_mean[0];
    const rollfix::Vec2 point = part.point(now);
    const double heading = part.tangent(now) + (part.reversed() ? std::numbers::pi : 0);
    const rollfix_place all{sizeof(rollfix_place),
                            mode.probability,
                            mode.start[0],
                            mode.sd[0],
                            mode.interval[0].lo,
                            mode.interval[0].hi,
                            now,
                            mode.end_sd[0],
                            point.x(),
                            point.y(),
                            std::remainder(heading, 2 * std::numbers::pi)};
    give(all, place);
    return ROLLFIX_OK;
  });
}

rollfix_code rollfix_restart(rollfix_locator* locator) {
  if (locator == nullptr) return ROLLFIX_INPUT;
  return guarded(nullptr, 0, [&] {
    locator->locator.restart();
    locator->is_located = false;
    return ROLLFIX_OK;
  });
}
