/* mechkin's core for other languages: a plan, a tape and constants in, rows out.
 *
 * A plan comes as text (core/text/plan_text.hpp), which Python writes (mechkin_cli/kernel/plan_text.py), with the
 * quantities that its runs write and, where it has parameters, the tape that gives its constants. Units are SI, lengths of
 * states and inputs in parts of the plan's length unit. Arrays of rows are (columns x rows), a column contiguous:
 * [column * rows + row]. Every row has the bits that Python's session gives it.
 *
 * Any number of threads may run a plan at once, as long as none changes it. */
#ifndef MECHKIN_H
#define MECHKIN_H

#include <stddef.h>

#if defined(__GNUC__)
#define MECHKIN_API __attribute__((visibility("default")))
#else
#define MECHKIN_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

typedef enum mechkin_status {
  MECHKIN_OK = 0,
  MECHKIN_REFUSED = 1,   /* what was given is not right; the message says why; nothing is changed */
  MECHKIN_OTHER_WAY = 2, /* with these parameters the file is computed in another way: the plan is to be built anew */
  MECHKIN_NO_MEMORY = 3
} mechkin_status;

/* Why something was refused: a sentence in English, cut where it is longer, or empty. */
typedef struct mechkin_message {
  char text[256];
} mechkin_message;

typedef struct mechkin_plan mechkin_plan;

typedef struct mechkin_sizes {
  size_t inputs, states, columns;
  size_t values;     /* columns of the quantities that runs write */
  size_t loads;      /* values of loads that vary */
  size_t input_constraints;       /* inputs that others lead */
  size_t turns;      /* angles and orientations of closing joints, whole turns of the tree's angles */
  size_t blocks;
  size_t constants;  /* of the plan, then of the quantities */
  size_t parameters; /* of the tape, 0 without one */
  size_t moving;     /* numbers that the tape gives behind the constants: inputs that move with the parameters */
} mechkin_sizes;

/* A message may be null wherever one is asked for. */
MECHKIN_API mechkin_status mechkin_plan_create(const char* text, size_t length, mechkin_plan** plan,
                                               mechkin_message* message);
MECHKIN_API void mechkin_plan_free(mechkin_plan* plan); /* or null */
MECHKIN_API mechkin_sizes mechkin_plan_sizes(const mechkin_plan* plan);

MECHKIN_API void mechkin_plan_constants(const mechkin_plan* plan, double* constants);
MECHKIN_API mechkin_status mechkin_plan_set_constants(mechkin_plan* plan, const double* constants,
                                                      mechkin_message* message);
/* The constants that the tape gives for some parameters (SI), and in `moving`, or null, what it gives behind them. */
MECHKIN_API mechkin_status mechkin_plan_set_parameters(mechkin_plan* plan, const double* parameters, double* moving,
                                                       mechkin_message* message);
/* The mechanism's size (m), by which residual and condition are measured. */
MECHKIN_API mechkin_status mechkin_plan_set_size(mechkin_plan* plan, double size, mechkin_message* message);

enum { /* what is computed beyond positions */
  MECHKIN_VELOCITY = 1,
  MECHKIN_ACCELERATION = 2, /* with velocities */
  MECHKIN_FORCES = 4,
  MECHKIN_CONDITION = 8,
  MECHKIN_POWER = 16, /* with forces */
  MECHKIN_JERK = 32,  /* with accelerations */
  MECHKIN_SINGULAR = 64 /* with the condition: to rounding instead of to 1 % */
};

enum { /* flags of a row, 0: closed */
  MECHKIN_NOT_CONVERGED = 1,
  MECHKIN_SIDE_CONDITION = 2
};

/* Rows that are closed from their guesses. What is not demanded may be null, and so may what is said to be optional. */
typedef struct mechkin_rows {
  size_t rows;
  /* given */
  const double* inputs;        /* inputs: rad and length units, without whole turns */
  const double* guess;         /* states */
  const double* rates;         /* inputs: with velocities */
  const double* accelerations; /* inputs: with accelerations */
  const double* jerks;         /* inputs: with jerks */
  const double* constraint_rates;          /* input_constraints: rates of led inputs by their leaders', with forces */
  const double* turned;        /* turns, optional: springs on angles and laws of loads go by them */
  const double* whole;         /* inputs, optional: whole turns that the inputs are without, likewise */
  const double* full;          /* inputs, optional: inputs with their whole turns, which laws of loads read */
  const double* time;          /* one a row (s), optional: likewise */
  /* found */
  double* states;       /* states */
  double* values;       /* values: the quantities in SI; null if and only if the plan has none */
  double* first;        /* columns, optional: derivatives, with velocities */
  double* second;       /* columns, optional: with accelerations */
  double* residual;     /* one a row */
  double* correction;   /* one a row: largest change of an unknown against its guess */
  double* side;         /* blocks, optional: signs of the square blocks' determinants, with any demand */
  double* condition;    /* one a row, with the condition */
  double* power_error;  /* one a row, with the power */
  double* loads;        /* loads, optional: with forces */
  unsigned char* flags; /* one a row */
  unsigned char* undefined; /* one a row, optional: whether a load has no value, with forces */
  unsigned demand;
  int iterations;               /* of Newton, at most */
  double tight, coarse, accept; /* its tests: residual, step, residual */
  int threads;                  /* that share the rows, 1 to 1024; no bit depends on it */
} mechkin_rows;

MECHKIN_API mechkin_status mechkin_run(const mechkin_plan* plan, const mechkin_rows* rows, mechkin_message* message);

#ifdef __cplusplus
}
#endif

#endif
