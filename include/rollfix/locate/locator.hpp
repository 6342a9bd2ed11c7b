#pragma once

#include <memory>
#include <vector>

#include "rollfix/locate/locate.hpp"

namespace rollfix {

/// Locates one roll after another and keeps its memory: for a loop that must not wait for an allocation. A reading of
/// one finger takes none, once there have been as many answers before; but for what an answer has more than two of
/// (roots of one connected set, readings), for two fingers, and where a search gives up or throws. Answers are those of
/// locate(). Of each thread its own.
class Locator {
 public:
  Locator();
  ~Locator();
  Locator(Locator&& other) noexcept;
  Locator& operator=(Locator&& other) noexcept;

  /// As locate() does; the answer is good until the next question.
  const Search& locate(const Part& part, const std::vector<Reading>& readings, const LocateOptions& options = {});
  const Search& locate(const Part& part, const Reading& reading, const LocateOptions& options = {});

 private:
  struct Memory;
  std::unique_ptr<Memory> memory_;
};

}  // namespace rollfix
