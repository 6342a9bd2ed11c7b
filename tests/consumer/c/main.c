/* A wheel with a gyroscope on a figure eight, in C99: is it found, and is nothing allocated once it has started? */
#include <math.h>
#include <rollfix/rollfix.h>
#include <stdio.h>
#include <stdlib.h>

#define POINTS 48
#define STEPS 20000 /* of the whole course */
#define ROWS 400

/* Every allocation of the program and of its libraries comes by here (glibc lends its own under these names). */
#ifdef __GLIBC__
extern void* __libc_malloc(size_t size);
extern void* __libc_calloc(size_t count, size_t size);
extern void* __libc_realloc(void* block, size_t size);
extern void* __libc_memalign(size_t alignment, size_t size);
static unsigned long allocations = 0;
void* malloc(size_t size) { return ++allocations, __libc_malloc(size); }
void* calloc(size_t count, size_t size) { return ++allocations, __libc_calloc(count, size); }
void* realloc(void* block, size_t size) { return ++allocations, __libc_realloc(block, size); }
void* aligned_alloc(size_t alignment, size_t size) { return ++allocations, __libc_memalign(alignment, size); }
#else
static unsigned long allocations = 0;
#endif

static const double pi = 3.14159265358979323846;

static double x_of(double t) { return 40 * sin(t) + 6 * cos(2 * t); }
static double y_of(double t) { return 18 * sin(2 * t) - 5 * cos(3 * t); }

/* Errors that look random and are the same everywhere: from -1 to 1. */
static double noise(void) {
  static unsigned long state = 1;
  state = (1103515245UL * state + 12345UL) & 0x7fffffffUL;
  return (double)state / 0x3fffffff - 1;
}

/* The next row: by about a 400th of the course along it. */
static void drive(double* t, double* distance, double* turn) {
  const double to = *t + 2 * pi / ROWS;
  double angle = atan2(y_of(*t + 1e-6) - y_of(*t), x_of(*t + 1e-6) - x_of(*t));
  *distance = *turn = 0;
  while (*t < to) {
    const double next = *t + 2 * pi / STEPS;
    const double dx = x_of(next) - x_of(*t);
    const double dy = y_of(next) - y_of(*t);
    const double ahead = atan2(y_of(next + 1e-6) - y_of(next), x_of(next + 1e-6) - x_of(next));
    *distance += sqrt(dx * dx + dy * dy);
    *turn += remainder(ahead - angle, 2 * pi);
    angle = ahead;
    *t = next;
  }
  *distance = 1.01 * *distance + 0.01 * noise();
  *turn = *turn + 0.003 * noise();
}

static int fail(const char* what) {
  fprintf(stderr, "consumer: %s\n", what);
  return 1;
}

int main(void) {
  double xy[2 * POINTS];
  char message[ROLLFIX_MESSAGE] = "";
  rollfix_part_options crossing = rollfix_default_part_options();
  rollfix_options options = rollfix_default_options();
  rollfix_part* eight = NULL;
  rollfix_locator* where = NULL;
  rollfix_answer answer = {0};
  rollfix_place place = {0};
  double t = 1.2, distance, turn;
  unsigned long before;
  int row, round;

  if (rollfix_abi() != ROLLFIX_ABI) return fail("the library is another one than the header");
  for (row = 0; row < POINTS; ++row) {
    xy[2 * row] = x_of(2 * pi * row / POINTS);
    xy[2 * row + 1] = y_of(2 * pi * row / POINTS);
  }
  crossing.allow_crossing = 1;
  if (rollfix_part_from_points(xy, POINTS, &crossing, &eight, message, sizeof message) != ROLLFIX_OK)
    return fail(message);
  options.distance = 0.02;
  options.turn = 0.003;
  options.slip = 0.01;
  options.gyro_scale = 0.01;
  options.gyro_bias = 1e-4;
  if (rollfix_start(eight, &options, &where, message, sizeof message) != ROLLFIX_OK) return fail(message);
  rollfix_part_free(eight);

  before = allocations;
  answer.struct_size = sizeof answer;
  place.struct_size = sizeof place;
  for (round = 0; round < 3; ++round) {
    for (row = 0; row < 5 * ROWS / 2; ++row) {
      drive(&t, &distance, &turn);
      if (rollfix_push(where, 0.1 * row, distance, turn) != ROLLFIX_OK) return fail("a row was refused");
      if (row % 10 == 0 && rollfix_locate(where, &answer) != ROLLFIX_OK) return fail("no answer");
    }
    if (rollfix_locate(where, &answer) != ROLLFIX_OK || rollfix_place_at(where, 0, &place) != ROLLFIX_OK)
      return fail("no place");
    if (answer.verdict != ROLLFIX_UNIQUE) return fail("expected one place");
    if (hypot(place.x - x_of(t), place.y - y_of(t)) > 1) return fail("it is elsewhere");
    if (round < 2 && rollfix_restart(where) != ROLLFIX_OK) return fail("no new start");
  }
  if (allocations != before) return fail("something was allocated after the start");
  printf(
      "at (%.2f, %.2f) +- %.2f m, distances %.4f +- %.4f times what was measured, in %lu bytes, %lu allocations "
      "before\n",
      place.x, place.y, place.now_sd, answer.distance_scale, answer.distance_scale_sd,
      (unsigned long)rollfix_bytes(where), before);
  rollfix_stop(where);
  return 0;
}
