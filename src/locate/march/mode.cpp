#include "rollfix/locate/march/mode.hpp"

#include <algorithm>

namespace rollfix::march {

void Mode::finish(Pair& pair) const {
  if (s_mark) {
    pair.s.jump(*s_mark);
  } else {
    pair.s.to_length(s_end);
  }
  if (t_mark) {
    pair.t.jump(*t_mark);
  } else {
    pair.t.to_length(t_end);
  }
}

Modes::Modes(const Path& path, const Preprocessed& preprocessed, const Pair& first)
    : preprocessed_(&preprocessed), closed_(path.closed()), segment_length_(first.problem.length) {
  const Span& loop = preprocessed.loop;
  if (closed_) {
    sweep_end_ = loop.length;
    last_s_ = first.s.position().moved_by(loop);
    last_t_ = first.t.position().moved_by(loop);
  } else {
    sweep_end_ = std::max(0.0, loop.length - segment_length_);
    last_t_ = preprocessed.back;
  }
}

bool Modes::exists(std::size_t number) const {
  return closed_ ? !preprocessed_->changes.empty() : number < preprocessed_->changes.size();
}

Position Modes::position_of(std::size_t number) const {
  const std::vector<SignChange>& changes = preprocessed_->changes;
  const std::size_t loops = number / changes.size();
  const Position& at = changes[number % changes.size()].at;
  return loops == 0 ? at : at.moved_by(preprocessed_->loop * static_cast<double>(loops));
}

double Modes::length_of(std::size_t number) const {
  const std::vector<SignChange>& changes = preprocessed_->changes;
  const std::size_t loops = number / changes.size();
  const double base = changes[number % changes.size()].at.here.length;
  return loops == 0 ? base : base + preprocessed_->loop.length * static_cast<double>(loops);
}

int Modes::sign_before(std::size_t number) const {
  const std::vector<SignChange>& changes = preprocessed_->changes;
  return number == 0 ? preprocessed_->first_sign : changes[(number - 1) % changes.size()].sign_after;
}

void Modes::pass(std::size_t& next, double length) const {
  while (exists(next) && length_of(next) <= length) ++next;
}

Mode Modes::at(const Pair& pair) {
  pass(next_s_, pair.s.length());
  pass(next_t_, pair.t.length());

  Mode mode;
  mode.sign_s = sign_before(next_s_);
  mode.sign_t = sign_before(next_t_);
  const bool s_may_end = exists(next_s_);
  const bool t_may_end = exists(next_t_);
  const double s_sign_change = s_may_end ? length_of(next_s_) : sweep_end_;                    // z_k
  const double t_sign_change = t_may_end ? length_of(next_t_) - segment_length_ : sweep_end_;  // sigma^-1(z_{l+1})
  mode.s_end = std::min({s_sign_change, t_sign_change, sweep_end_});
  mode.t_end = mode.s_end + segment_length_;
  if (mode.s_end == sweep_end_) {
    mode.s_mark = last_s_;
    mode.t_mark = last_t_;
    return mode;
  }
  if (s_may_end && s_sign_change == mode.s_end) mode.s_mark = position_of(next_s_);
  if (t_may_end && t_sign_change == mode.s_end) {
    mode.t_mark = position_of(next_t_);
    mode.t_end = mode.t_mark->here.length;
  }
  return mode;
}

}  // namespace rollfix::march
