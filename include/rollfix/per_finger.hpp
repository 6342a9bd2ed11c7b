#pragma once

#include "rollfix/cpp20.hpp"  // IWYU pragma: keep

#include <array>
#include <cstddef>
#include <utility>
#include <vector>

namespace rollfix {

/// One entry for each finger, one or two, kept in place.
template <class T>
class PerFinger {
 public:
  PerFinger() = default;                                 // of one finger
  PerFinger(T only) : entries_{std::move(only), T{}} {}  // NOLINT: one finger's is an entry
  PerFinger(T of_a, T of_b) : entries_{std::move(of_a), std::move(of_b)}, size_(2) {}
  PerFinger(const std::array<T, 2>& of_both) : entries_(of_both), size_(2) {}  // NOLINT: it is of both fingers
  /// The same for each of so many fingers, 1 or 2.
  static PerFinger of(std::size_t fingers, const T& entry = T{}) {
    return fingers == 2 ? PerFinger(entry, entry) : PerFinger(entry);
  }

  std::size_t size() const { return size_; }
  T& operator[](std::size_t finger) { return entries_[finger]; }
  const T& operator[](std::size_t finger) const { return entries_[finger]; }
  T* begin() { return entries_.data(); }
  T* end() { return entries_.data() + size_; }
  const T* begin() const { return entries_.data(); }
  const T* end() const { return entries_.data() + size_; }

  bool operator==(const PerFinger& other) const {
    return size_ == other.size_ && entries_[0] == other.entries_[0] && (size_ == 1 || entries_[1] == other.entries_[1]);
  }

 private:
  std::array<T, 2> entries_{};
  std::size_t size_ = 1;
};

/// A list that is mostly short: up to two entries are kept in place.
template <class T>
class ShortList {
 public:
  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  T* begin() { return size_ > kInPlace ? many_.data() : few_.data(); }
  T* end() { return begin() + size_; }
  const T* begin() const { return size_ > kInPlace ? many_.data() : few_.data(); }
  const T* end() const { return begin() + size_; }
  T& operator[](std::size_t k) { return begin()[k]; }
  const T& operator[](std::size_t k) const { return begin()[k]; }
  const T& front() const { return *begin(); }
  const T& back() const { return end()[-1]; }

  void push_back(T entry) {
    if (size_ < kInPlace) {
      few_[size_++] = std::move(entry);
      return;
    }
    if (size_ == kInPlace) many_.assign(few_.begin(), few_.end());
    many_.push_back(std::move(entry));
    ++size_;
  }
  void clear() {
    many_.clear();
    size_ = 0;
  }

 private:
  static constexpr std::size_t kInPlace = 2;
  std::array<T, kInPlace> few_{};
  std::vector<T> many_;
  std::size_t size_ = 0;
};

}  // namespace rollfix
