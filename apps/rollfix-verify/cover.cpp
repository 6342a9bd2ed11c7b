#include "cover.hpp"

#include <charconv>
#include <cmath>
#include <stdexcept>
#include <system_error>

#include "budget.hpp"

namespace rollfix_verify {
namespace {

constexpr int kMostSplits = 200;
constexpr double kLeafWork = 0.1;  // in expansions
const std::string kLevels = "0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZabcdef";

class Reader {
 public:
  Reader(const std::string& text, const std::function<void(const Leaf&)>& use) : text_(text), use_(use) {}

  void read(const Box& box, int depth) {
    Budget::spend(kLeafWork);
    const char token = next();
    if (token == 's' || token == 't') {
      if (depth == kMostSplits) throw std::domain_error("its cells are halved too often");
      const std::size_t finger = token == 's' ? 0 : 1;
      const double middle = box[finger].lo + 0.5 * box[finger].width();
      Box half = box;
      half[finger].hi = middle;
      read(half, depth + 1);
      half[finger] = {middle, box[finger].hi};
      read(half, depth + 1);
      return;
    }
    Leaf leaf{Leaf::unproved, box};
    if (token == '[') {
      leaf.kind = Leaf::placement;
      leaf.number = number();
    } else if (token != '?') {
      const std::size_t level = kLevels.find(token);
      if (level == std::string::npos) throw std::domain_error("its cells have an unknown letter");
      leaf.kind = Leaf::apart;
      leaf.bound = std::ldexp(1.0, -static_cast<int>(level));
    }
    use_(leaf);
  }

  bool is_at_end() const { return at_ == text_.size(); }

 private:
  char next() {
    if (is_at_end()) throw std::domain_error("its cells do not cover everything");
    return text_[at_++];
  }

  std::size_t number() {
    std::size_t value = 0;
    const char* const end = text_.data() + text_.size();
    const auto [behind, error] = std::from_chars(text_.data() + at_, end, value);
    if (error != std::errc() || behind == end || *behind != ']') {
      throw std::domain_error("its cells name a placement by no number");
    }
    at_ = static_cast<std::size_t>(behind - text_.data()) + 1;
    return value;
  }

  const std::string& text_;
  const std::function<void(const Leaf&)>& use_;
  std::size_t at_ = 0;
};

}  // namespace

void read_cover(const std::string& text, const Box& whole, const std::function<void(const Leaf&)>& use) {
  Reader reader(text, use);
  reader.read(whole, 0);
  if (!reader.is_at_end()) throw std::domain_error("its cells go on behind the last one");
}

}  // namespace rollfix_verify
