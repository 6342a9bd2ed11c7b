#pragma once

namespace rollfix {

/// What the program does as long as this lives, where that may take long: for whoever waits before a terminal. Of two
/// the one that began later counts.
class Doing {
 public:
  explicit Doing(const char* what);  // a literal: "measuring the outline"
  ~Doing();
  Doing(const Doing&) = delete;
  Doing& operator=(const Doing&) = delete;

  /// So much of it is done, from 0 to 1.
  void tell(double share) const;

  /// What is done now, and how much of it; below 0: not known. nullptr: nothing that takes long.
  struct Now {
    const char* what = nullptr;
    double share = -1;
  };
  static Now now();

 private:
  Now before_;
};

}  // namespace rollfix
