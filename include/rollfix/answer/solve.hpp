#pragma once

#include "rollfix/cpp20.hpp"  // IWYU pragma: keep

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "rollfix/answer/answer.hpp"

namespace rollfix {

/// From a part and a roll on it to every place where the roll can have started: the readings that are meant and the
/// tolerance that their digits or their noise ask for, the search, with noise the weighing of all rows, what the
/// fingers can't do, and where the part is in the world. One finger on a part at rest, or two on a part that is free to
/// move. Throws InputError: what `locate`, `readings`, `facing` and Belief throw, and a fact that does not go with the
/// others, by the name of the Problem's field.
Answer solve(const Problem& problem);

/// Whether it is known where such a finger can touch a part without entering it elsewhere: of disks and jaws.
bool has_reach(const Finger& finger);

/// How far it can reach. REQUIRES has_reach(finger). Throws InputError as reach_of_disk does.
Reach reach_of(const Part& part, const Finger& finger);

/// How to work on many problems.
struct ManyOptions {
  unsigned threads = 0;  // 0: as many as the machine has processors
  /// Called now and then by the thread that waits, with the number of problems that are done: false stops the work.
  std::function<bool(std::size_t done)> go_on{};
};

/// An answer, or why there is none: what `solve` of that problem throws as InputError.
struct Solved {
  std::optional<Answer> answer{};
  std::string error{};
};

/// An answer to each problem, in order; the same bits with any number of threads. Throws what `solve` throws but
/// InputError, and InputError where go_on stopped it.
std::vector<Solved> solve(std::span<const Problem> problems, const ManyOptions& options = {});

/// Many answers as columns, for when there are too many to keep each: placement number p of problem k is row
/// offsets[k] + p. What is of a finger has `fingers` entries in a row, [row * fingers + finger].
struct AnswerTable {
  std::size_t fingers = 1;
  std::vector<std::int64_t> offsets{0};  // of the problems, and behind the last the number of rows

  // Of each problem:
  std::vector<std::uint8_t> status;                         // as Status
  std::vector<std::uint8_t> verdict;                        // as Verdict::Name
  std::vector<double> tolerance;                            // radians; NaN where there is an error
  std::vector<std::pair<std::size_t, std::string>> errors;  // problem and message, in order

  // Of each placement:
  std::vector<std::uint8_t> kind;        // as Kind
  std::vector<double> start;             //
  std::vector<double> end;               //
  std::vector<double> extent;            // lo, hi of each finger
  std::vector<double> point;             // x, y of each finger
  std::vector<double> tangent;           //
  std::vector<double> error;             // one a row
  std::vector<double> residual;          // one a row
  std::vector<double> probability;       // one a row; NaN without noise
  std::vector<std::uint8_t> whole_loop;  // of finger a or of both

  std::size_t problems() const { return offsets.size() - 1; }
};

/// Turns the problem that it is given, which is `like` or an earlier one, into number k. It is called from several
/// threads, of each with a problem of its own. What it throws as InputError is that problem's error.
using ProblemMaker = std::function<void(std::size_t k, Problem& problem)>;

/// The answers to problems 0 to count - 1, all of as many fingers as `fingers`. Throws as `solve` of a span.
AnswerTable solve_table(const Problem& like, std::size_t count, const ProblemMaker& make, std::size_t fingers,
                        const ManyOptions& options = {});

}  // namespace rollfix
