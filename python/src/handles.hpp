#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "made.hpp"
#include "rollfix/advise.hpp"
#include "rollfix/error.hpp"
#include "rollfix/files.hpp"
#include "rollfix/hold.hpp"
#include "rollfix/identify.hpp"
#include "rollfix/log.hpp"
#include "rollfix/part.hpp"
#include "rollfix/plan.hpp"
#include "rollfix/question.hpp"
#include "rollfix/rolling.hpp"
#include "rollfix/solve.hpp"
#include "rollfix/touch.hpp"

// What Python holds of the library's values. All are immutable and shared, so that a thread that works without the
// interpreter's lock keeps what it works on, whatever Python does meanwhile.
namespace rollfix::python {

namespace py = pybind11;

/// A part. Closing it lets go of what was computed; whoever works on it has a share.
class PartHandle {
 public:
  explicit PartHandle(LoadedPart loaded) : loaded_(std::make_shared<const LoadedPart>(std::move(loaded))) {}
  explicit PartHandle(const Part& part) : PartHandle(LoadedPart{part, part.unit(), {}, 0, {}}) {}

  /// Throws InputError: closed.
  std::shared_ptr<const LoadedPart> loaded() const {
    if (!loaded_) throw InputError("part: was closed; make it again, or close it later");
    return loaded_;
  }
  Part part() const { return loaded()->part; }
  bool is_open_for_use() const { return loaded_ != nullptr; }
  void close() { loaded_.reset(); }

 private:
  std::shared_ptr<const LoadedPart> loaded_;
};

struct AnswerHandle {
  std::shared_ptr<const Answer> answer;
};

struct LogHandle {
  std::shared_ptr<const Log> log;
};

struct CatalogHandle {
  std::shared_ptr<const Catalog> catalog;
};

struct RollHandle {
  std::shared_ptr<const NoisyRoll> roll;
};

struct TouchAnswerHandle {
  std::shared_ptr<const TouchAnswer> answer;
};

struct HoldAnswerHandle {
  std::shared_ptr<const HoldAnswer> answer;
  std::shared_ptr<const HoldProblem> problem;  // that it answers
};

struct NextRollHandle {
  std::shared_ptr<const NextRoll> next;
};

/// One of an answer's placements.
struct PlacementHandle {
  std::shared_ptr<const Answer> answer;
  std::size_t index = 0;

  const Placement& operator*() const { return answer->placements[index]; }
  const Placement* operator->() const { return &answer->placements[index]; }
};

template <>
inline constexpr bool kIsPythonClass<PartHandle> = true;
template <>
inline constexpr bool kIsPythonClass<AnswerHandle> = true;
template <>
inline constexpr bool kIsPythonClass<LogHandle> = true;
template <>
inline constexpr bool kIsPythonClass<CatalogHandle> = true;
template <>
inline constexpr bool kIsPythonClass<RollHandle> = true;
template <>
inline constexpr bool kIsPythonClass<NextRollHandle> = true;
template <>
inline constexpr bool kIsPythonClass<TouchAnswerHandle> = true;
template <>
inline constexpr bool kIsPythonClass<HoldAnswerHandle> = true;
template <>
inline constexpr bool kIsPythonClass<PlacementHandle> = true;
template <>
inline constexpr bool kIsPythonClass<Reach> = true;
template <>
inline constexpr bool kIsPythonClass<Question> = true;

/// A plan and what it is of.
struct PlanHandle {
  std::shared_ptr<const PlanProblem> problem;
  std::shared_ptr<const Plan> plan;
};

template <>
inline constexpr bool kIsPythonClass<PlanHandle> = true;

}  // namespace rollfix::python
