#pragma once

namespace bench {

/// Each prints its table to standard output: what a search costs in units of W, see perimeter_by_quadrature.
/// `rounds` of measurement, each of every job in turn; the least is printed: what else the machine does only adds.
void one_finger(int rounds);
void two_fingers(int rounds);
/// In microseconds: loading a saved part, building it anew with the look for crossings, the reach of a disk.
void files(int rounds);

}  // namespace bench
