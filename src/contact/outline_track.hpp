#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "contact/track.hpp"

namespace rollfix {

/// The way of a finger with an outline: that of a point, cut where a spiral of the finger ends and another begins. The
/// pieces are found as they are needed; index 0 is where the roll starts.
class OutlineTrack : public Track {
 public:
  /// The first contact is at s = start, in [0, P), and at u on the finger. Throws InputError where the finger can't be.
  OutlineTrack(const Part& part, const Finger& finger, double start, double u);

  Stretch stretch(std::int64_t index) const override { return piece(index).stretch; }
  TrackPlace place(double s, int direction) const override;
  std::optional<std::int64_t> next(std::int64_t index, int direction) const override;
  [[noreturn]] void refuse(std::int64_t index, int direction) const override;
  double fall_between(std::int64_t from, std::int64_t to) const override;
  void require_way(double from, double to) const override;
  double rotation(const Stretch& stretch, double s, double angle) const override;
  double finger_curvature(const Stretch& stretch, double s) const override;
  Contact first_contact(double tangent, double psi) const override;

 private:
  struct Piece {
    std::int64_t base = 0;     // the point's stretch
    std::int64_t cell = 0;     // which of the finger's spirals, on over its laps
    Stretch stretch;           // cut
    bool is_tight_lo = false;  // the finger does not fit beyond this end
    bool is_tight_hi = false;
    double jump = 0;  // by which the finger's tiny joints have turned it since piece 0
  };

  const Piece& piece(std::int64_t index) const;
  void set_cell(Piece& piece, std::int64_t cell) const;
  Interval cell_range(const Piece& piece) const;
  Turning on_finger(const Stretch& stretch, double s) const;
  bool has_room(const Stretch& stretch, const Interval& s) const;
  std::optional<double> first_tight(const Stretch& stretch, double from, double to) const;
  void cut(Piece& piece, double from, int direction) const;
  std::optional<Piece> follow(const Piece& piece, int direction) const;
  bool finger_ends(std::int64_t cell) const;

  EvenTrack point_;  // the way of a finger without any size
  double sum_;       // s + u, which stays
  double u_;
  double near_;                        // lengths closer together than this are one place
  mutable std::vector<Piece> ahead_;   // 0, 1, 2 ...
  mutable std::vector<Piece> behind_;  // -1, -2 ...
};

}  // namespace rollfix
