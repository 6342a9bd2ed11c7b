// How much memory does a part take, and a query? What is asked of the heap is counted; this program is not timed.

#include <malloc.h>

#include <algorithm>
#include <cstdlib>
#include <new>
#include <string>
#include <vector>

#include "outlines.hpp"
#include "program.hpp"
#include "questions.hpp"
#include "table.hpp"

namespace {

std::size_t held = 0;  // bytes of the heap, as it gave them
std::size_t most_held = 0;

void* take(std::size_t size) {
  void* const memory = std::malloc(size);
  if (memory == nullptr) throw std::bad_alloc();
  held += malloc_usable_size(memory);
  most_held = std::max(most_held, held);
  return memory;
}

void give_back(void* memory) {
  if (memory == nullptr) return;
  held -= malloc_usable_size(memory);
  std::free(memory);
}

/// What a call holds at most beyond what was held before, its result included.
template <class Call>
double most_bytes(Call&& call) {
  const std::size_t before = held;
  most_held = held;
  bench::keep(call());
  return static_cast<double>(most_held - before);
}

using namespace rollfix;

constexpr std::size_t kQuestions = 50;

std::vector<std::string> row_of(const std::string& name, const Outline& outline) {
  const std::size_t before = held;
  const Part part = bench::trusted_part(outline);
  const auto bytes = static_cast<double>(held - before);
  double one = 0;
  double two = 0;
  for (const Reading& reading : bench::random_readings(part, kQuestions)) {
    one = std::max(one, most_bytes([&] { return locate(part, reading); }));
  }
  for (const bench::PairQuestion& question : bench::random_pair_questions(part, kQuestions)) {
    two = std::max(two, most_bytes([&] { return bench::find(part, question); }));
  }
  const std::size_t spirals = part.turning().spirals().size();
  return {name,
          std::to_string(spirals),
          bench::cell(bytes / 1024, 1),
          bench::cell(bytes / static_cast<double>(spirals), 0),
          bench::cell(one / 1024, 1),
          bench::cell(two / 1024, 0)};
}

}  // namespace

void* operator new(std::size_t size) { return take(size); }
void* operator new[](std::size_t size) { return take(size); }
void operator delete(void* memory) noexcept { give_back(memory); }
void operator delete[](void* memory) noexcept { give_back(memory); }
void operator delete(void* memory, std::size_t /*size*/) noexcept { give_back(memory); }
void operator delete[](void* memory, std::size_t /*size*/) noexcept { give_back(memory); }

int main(int argc, char** argv) {
  const bench::Program program(argc, argv);
  bench::Table table({"outline", "spirals", "part [KiB]", "bytes a spiral", "one finger [KiB]", "two fingers [KiB]"});
  for (const bench::Family& family : bench::families()) table.add(row_of(family.name, family.outline));
  for (const int points : {2000, 20000}) {
    table.add(row_of("egg, " + std::to_string(points) + " points", bench::egg_through_points(points)));
  }
  table.print();
  program.write_figures();
}
