#include "doing.hpp"

#include <atomic>

namespace rollfix {
namespace {

std::atomic<const char*> current_what{nullptr};
std::atomic<double> current_share{-1};

}  // namespace

Doing::Doing(const char* what) : before_(now()) {
  current_share = -1;
  current_what = what;
}

Doing::~Doing() {
  current_what = before_.what;
  current_share = before_.share;
}

void Doing::tell(double share) const { current_share.store(share, std::memory_order_relaxed); }

Doing::Now Doing::now() { return {current_what, current_share}; }

}  // namespace rollfix
