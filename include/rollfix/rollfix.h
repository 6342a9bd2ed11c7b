/* Where on a known course is a wheel with a gyroscope, or a finger? The C interface: C99, no exceptions, and no
 * allocation after rollfix_start.
 *
 *   rollfix_part* track = NULL;
 *   rollfix_locator* where = NULL;
 *   char message[ROLLFIX_MESSAGE];
 *   rollfix_options options = rollfix_default_options();
 *   options.distance = 0.01;  (m, of each row)
 *   options.turn = 0.002;     (rad, of each row)
 *   if (rollfix_part_load("track.csv", NULL, &track, message, sizeof message) != ROLLFIX_OK) ...
 *   if (rollfix_start(track, &options, &where, message, sizeof message) != ROLLFIX_OK) ...
 *   for each row:  rollfix_push(where, seconds, distance, turn);
 *   when it matters:  rollfix_locate(where, &answer);  rollfix_place_at(where, 0, &place);
 *
 * Lengths are in the part's unit, angles in radians, times in seconds. Every function returns a rollfix_code unless it
 * says otherwise; where one takes `message` and `size` and fails, it writes one line there: what was expected, what was
 * found, the cure. `message` may be NULL.
 *
 * Stable: handles are opaque, and every struct begins with its own size, `struct_size`, which who makes it sets to
 * sizeof (0 is refused, ROLLFIX_INPUT). A library that knows more fields takes their defaults, one that knows fewer
 * leaves them as they are. Codes and fields are added, never changed.
 *
 * Threads: a handle is for one thread at a time. Different handles don't know of each other; a part may be shared. */
#ifndef ROLLFIX_H
#define ROLLFIX_H

#include <stddef.h>
#include <stdint.h>

#if defined(__GNUC__)
#define ROLLFIX_API __attribute__((visibility("default")))
#else
#define ROLLFIX_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

#define ROLLFIX_ABI 1       /* grows when something here changes that was there */
#define ROLLFIX_MESSAGE 512 /* a buffer that holds any message */

typedef enum rollfix_code {
  ROLLFIX_OK = 0,
  ROLLFIX_INPUT = 1,   /* what was given can't be worked with: the message says why */
  ROLLFIX_MEMORY = 2,  /* at the start: there is none. Later: the locator's own is used up, rollfix_restart it */
  ROLLFIX_NOTHING = 3, /* there is no such place, or no row yet */
  ROLLFIX_INTERNAL = 4 /* a computation broke a promise of its own */
} rollfix_code;

/* As int32_t in the structs, so that their layout is the same everywhere. */
typedef enum rollfix_verdict {
  ROLLFIX_UNIQUE = 0,       /* one place */
  ROLLFIX_AMBIGUOUS = 1,    /* several places, or one wide stretch */
  ROLLFIX_UNOBSERVABLE = 2, /* all of a closed course fits */
  ROLLFIX_INCONSISTENT = 3, /* nothing fits: the rows are not of this course, or noisier than stated */
  ROLLFIX_UNDECIDED = 4     /* `points` did not suffice: more than 5 % of the probability may be elsewhere */
} rollfix_verdict;

typedef struct rollfix_part rollfix_part;       /* a course; immutable */
typedef struct rollfix_locator rollfix_locator; /* a log that grows on it */

/* How a course is read. */
typedef struct rollfix_part_options {
  size_t struct_size;
  int32_t open;           /* 1: the points are a curve with two ends */
  int32_t allow_crossing; /* 1: it may cross itself, as a figure eight does */
  double corner_angle;    /* chords that turn by at least this make a corner; radians; below 0: 59 degrees */
} rollfix_part_options;

/* Standard deviations of what is measured, and how much memory a locator may use. */
typedef struct rollfix_options {
  size_t struct_size;
  double distance;   /* of each row's distance, independent of others; this or `turn` above 0 */
  double turn;       /* of each row's turn, radians; at most 0.5 */
  double slip;       /* of all distances by one factor (the wheel's size), and five times that over short stretches */
  double gyro_scale; /* of all turns by one factor */
  double gyro_bias;  /* of the gyroscope's rate all along, radians per second */
  double gyro_walk;  /* angle random walk, radians per square root of a second */
  size_t points;     /* most first contacts on trial at once; 0: as many as rollfix_start recommends */
} rollfix_options;

/* What all rows so far say together. */
typedef struct rollfix_answer {
  size_t struct_size;
  int32_t verdict;       /* a rollfix_verdict */
  int32_t contradicts;   /* 1: the rows contradict the stated noise; the answer is widened */
  size_t rows;           /* so far */
  size_t places;         /* rollfix_place_at takes 0 to places - 1 */
  double rest;           /* probability of what is not listed, and of what memory did not suffice for */
  double excess;         /* rows are off by so many times the stated noise; 1: they are not */
  double distance_scale; /* distances are this many times what was measured, ... */
  double distance_scale_sd;
  double turn_scale;    /* ... and turns, ... */
  double turn_scale_sd; /* (0: stated as exact) */
  double gyro_bias;     /* ... and the gyroscope's rate is this much too high, radians per second */
  double gyro_bias_sd;
} rollfix_answer;

/* A place where the log can have started, the most probable first. */
typedef struct rollfix_place {
  size_t struct_size;
  double probability;
  double start; /* arc length at the first row's beginning, in [0, length of the course) */
  double start_sd;
  double start_lo; /* 95 % interval; start_hi may exceed the length of a closed course */
  double start_hi;
  double now;    /* arc length now: its mean, ... */
  double now_sd; /* ... and standard deviation */
  double x;      /* the course's point there, ... */
  double y;
  double heading; /* ... and the direction of travel along it, as drawn; radians */
} rollfix_place;

/* ROLLFIX_ABI of the library, and its version as text. */
ROLLFIX_API int32_t rollfix_abi(void);
ROLLFIX_API const char* rollfix_version(void);

/* Structs with their size and the defaults. */
ROLLFIX_API rollfix_part_options rollfix_default_part_options(void);
ROLLFIX_API rollfix_options rollfix_default_options(void);

/* A course through points x0, y0, x1, y1, ... (a spline, with corners), or of a file: points, a saved part, DXF, SVG,
 * or "gallery:NAME,key=value". `options` NULL: the defaults. It is given back with rollfix_part_free. */
ROLLFIX_API rollfix_code rollfix_part_from_points(const double* xy, size_t points, const rollfix_part_options* options,
                                                  rollfix_part** part, char* message, size_t size);
ROLLFIX_API rollfix_code rollfix_part_load(const char* path, const rollfix_part_options* options, rollfix_part** part,
                                           char* message, size_t size);
ROLLFIX_API void rollfix_part_free(rollfix_part* part); /* NULL: nothing */

/* Of the course: its length, and 1 where it was drawn clockwise: it is stored the other way round, and s counts so.
 * Of NULL: 0. */
ROLLFIX_API double rollfix_part_length(const rollfix_part* part);
ROLLFIX_API int32_t rollfix_part_reversed(const rollfix_part* part);

/* Takes all the memory that the locator will ever have, rollfix_bytes. `part` may be freed after it. ROLLFIX_INPUT:
 * noise that is not valid, or too few `points` for such a course. */
ROLLFIX_API rollfix_code rollfix_start(const rollfix_part* part, const rollfix_options* options,
                                       rollfix_locator** locator, char* message, size_t size);
ROLLFIX_API void rollfix_stop(rollfix_locator* locator);          /* NULL: nothing */
ROLLFIX_API size_t rollfix_bytes(const rollfix_locator* locator); /* of that memory; of NULL: 0 */

/* The next row: what wheel and gyroscope have added since the row before; positive along the course as drawn, turns
 * counter-clockwise. `seconds` grows from row to row; where neither bias nor walk is stated it may stay 0. The first
 * row is taken to last as long as the second; or push the start itself first, without distance and turn. A row that
 * is not valid is refused (ROLLFIX_INPUT) and leaves all as it was. Takes about a microsecond. */
ROLLFIX_API rollfix_code rollfix_push(rollfix_locator* locator, double seconds, double distance, double turn);

/* Works out what all rows say: milliseconds at first, tenths of one when the place is known. ROLLFIX_NOTHING: no row.
 */
ROLLFIX_API rollfix_code rollfix_locate(rollfix_locator* locator, rollfix_answer* answer);

/* A place of the last answer. ROLLFIX_NOTHING: there are no so many. */
ROLLFIX_API rollfix_code rollfix_place_at(const rollfix_locator* locator, size_t index, rollfix_place* place);

/* Forgets all rows: the wheel was carried elsewhere. Allocates nothing. */
ROLLFIX_API rollfix_code rollfix_restart(rollfix_locator* locator);

#ifdef __cplusplus
}
#endif
#endif
