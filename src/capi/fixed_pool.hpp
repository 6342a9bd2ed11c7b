#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <memory_resource>
#include <new>

namespace rollfix::capi {

/// Memory for all that is ever asked of it, taken once. What is given back serves the next that asks for as much, to a
/// quarter: sizes are rounded up to four for each power of two, and blocks are neither cut nor joined. Throws
/// std::bad_alloc where nothing is left.
class FixedPool : public std::pmr::memory_resource {
 public:
  explicit FixedPool(std::size_t bytes) : memory_(new std::byte[bytes]), bytes_(bytes) {}

  std::size_t bytes() const { return bytes_; }
  std::size_t used() const { return used_; }  // at most so far
  /// All that was taken is free again. REQUIRES that nobody uses it.
  void clear() {
    used_ = 0;
    free_.fill(nullptr);
  }

 private:
  struct Free {
    Free* next;
  };
  static constexpr std::size_t kLeast = 64;  // as aligned as anything is
  static constexpr std::size_t kClasses = 4 * 58;

  struct Block {
    std::size_t bytes;
    std::size_t number;  // of its class
  };
  static Block block_of(std::size_t bytes) {
    std::size_t power = kLeast;
    std::size_t number = 0;
    for (; 2 * power < bytes; power *= 2) number += 4;
    if (bytes <= power) return {power, number};
    const std::size_t step = power / 4;
    const std::size_t steps = (bytes - power + step - 1) / step;
    return {power + steps * step, number + steps};
  }

  void* do_allocate(std::size_t bytes, std::size_t /*alignment*/) override {
    const Block block = block_of(bytes);
    if (Free* const one = free_[block.number]) {
      free_[block.number] = one->next;
      return one;
    }
    const std::size_t aligned = (block.bytes + kLeast - 1) / kLeast * kLeast;
    void* place = memory_.get() + used_;
    std::size_t left = bytes_ - used_;
    if (std::align(kLeast, aligned, place, left) == nullptr) throw std::bad_alloc();
    used_ = bytes_ - left + aligned;
    return place;
  }
  void do_deallocate(void* place, std::size_t bytes, std::size_t /*alignment*/) override {
    Free*& first = free_[block_of(bytes).number];
    first = new (place) Free{first};
  }
  bool do_is_equal(const std::pmr::memory_resource& other) const noexcept override { return this == &other; }

  std::unique_ptr<std::byte[]> memory_;
  std::size_t bytes_;
  std::size_t used_ = 0;
  std::array<Free*, kClasses> free_{};
};

}  // namespace rollfix::capi
