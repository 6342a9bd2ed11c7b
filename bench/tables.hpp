#pragma once

namespace bench {

/// Each prints its table to standard output: what a search costs in units of W, see perimeter_by_quadrature.
/// `rounds` of measurement, each of every job in turn; the least is printed: what else the machine does only adds.
void one_finger(int rounds);
void two_fingers(int rounds);
/// In microseconds: loading a saved part, building it anew with the look for crossings, the reach of a disk.
void files(int rounds);
/// In microseconds per sample: a growing log, from a line to where the contact is.
void watch(int rounds);
/// In milliseconds: a noisy log's probabilities, on one shape through few points and through many.
void posterior(int rounds);
/// How often noisy logs are localized, beside particle filters; so many logs on each part.
void noisy(int count);
/// How often two advised rolls leave one place; so many cases on each part.
void advised(int count);

}  // namespace bench
