#pragma once

namespace bench {

/// Each prints its table to standard output: what a search costs in units of W, see perimeter_by_quadrature.
/// `rounds` of measurement, each of every job in turn; the least is printed: what else the machine does only adds.
void one_finger(int rounds);
void two_fingers(int rounds);

}  // namespace bench
