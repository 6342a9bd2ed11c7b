#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "rollfix/contact/finger.hpp"
#include "rollfix/contact/log.hpp"
#include "rollfix/contact/reading.hpp"
#include "rollfix/part/part.hpp"

namespace rollfix {

/// Finger a and finger b.
using FingerPair = std::array<Finger, 2>;

/// What two fingers recorded together while both touched the part. Row k of both is the same instant.
struct PairLog {
  Log a;
  Log b;

  std::size_t rows() const { return a.rows(); }
};

/// Two fingers' logs as one, by row. Where a contact column left out rows of one of them, both are cut to the times
/// that they share. Throws InputError: logs of different kinds, different times, different numbers of rows (naming the
/// lines), or too few rows together.
PairLog paired(Log a, Log b);

/// Reads a log of two fingers: columns time, u_a, psi_a, u_b, psi_b (or length_a, turn_a, ...), optionally x_a, y_a,
/// x_b, y_b and contact_a, contact_b or contact, otherwise like read_log. Throws InputError as that does, and where
/// the file is of one finger only.
PairLog read_pair_log(const std::string& path);
PairLog parse_pair_log(std::string_view text, const std::string& name);

/// Reads two logs, one of each finger, with the same times. Throws InputError as read_log and `paired` do.
PairLog read_pair_log(const std::string& path_a, const std::string& path_b);

/// time,u_a,psi_a,x_a,y_a,u_b,psi_b,x_b,y_b (or length_a,...), 17 significant digits each: reading it back gives the
/// same bits. Throws InputError as format_log does, and where the times differ.
std::string format_pair_log(const PairLog& log);

/// Writes that to a file, "-" for standard output. Throws InputError when it can't be written.
void write_pair_log(const std::string& path, const PairLog& log);

/// The rows that are meant by these instants, as of one finger's log. No instants: the middle row and the last, because
/// two fingers need two readings; only the last where the log is too short for both.
std::vector<std::size_t> rows_at(const PairLog& log, const std::vector<double>& times);

/// Every row as a reading from the first contacts, lengths along the outline as the user gave it: eqs. (7)-(9).
/// Throws InputError: u and psi without the fingers.
std::vector<Reading> readings_as_given(const PairLog& log, const std::optional<FingerPair>& fingers);

/// The readings at these instants (see rows_at) in the direction in which the part is stored: what `locate` takes.
std::vector<Reading> readings(const PairLog& log, const Part& part, const std::optional<FingerPair>& fingers,
                              const std::vector<double>& times = {});

/// (N(u) + psi) of finger a less that of finger b, u + psi of disks, at the first contacts, which is Theta(s) -
/// Theta(t) up to whole turns, in (-pi, pi]. Nothing where the logs don't have it: length and turn, distance and dturn.
/// Without fingers they are disks.
std::optional<double> facing(const PairLog& log, const std::optional<FingerPair>& fingers = std::nullopt);

/// How far the digits that were written can have moved such a reading, at worst: `length` both of its lengths together,
/// `turn` its turn. The facing can't be further off than the turn.
Rounding rounding_of(const PairLog& log, const std::optional<FingerPair>& fingers);

}  // namespace rollfix
