#include "cover.hpp"

#include <cmath>
#include <stdexcept>

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
      const double middle = box[finger].lo + 0.5 * (box[finger].hi - box[finger].lo);
      Box first = box;
      Box second = box;
      first[finger].hi = middle;
      second[finger].lo = middle;
      read(first, depth + 1);
      read(second, depth + 1);
      return;
    }
    Leaf leaf;
    leaf.box = box;
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
    char digit = next();
    for (int k = 0; k < 9 && digit >= '0' && digit <= '9'; ++k, digit = next()) {
      value = 10 * value + static_cast<std::size_t>(digit - '0');
    }
    if (digit != ']') throw std::domain_error("its cells name a placement by no number");
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
