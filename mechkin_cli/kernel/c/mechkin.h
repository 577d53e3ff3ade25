/* mechkin's core for other languages: a plan, a tape and constants in, rows out; and variants of a plan, whose rows are
 * found from nothing but its parameters.
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
  size_t variant_rows; /* rows of a variant or response, 0 where the text does not say what these have in common */
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

typedef enum mechkin_end {
  MECHKIN_COMPLETE = 0,
  MECHKIN_BUILT_ANEW = 1, /* with these parameters the file is computed in another way: the plan is to be built anew */
  MECHKIN_LOST = 2,       /* the assembly could not be followed from the file's parameters to these */
  MECHKIN_INCOMPLETE = 3  /* some row was not reached, or did not close near its guess */
} mechkin_end;

typedef enum mechkin_stop { /* why rows end on one side of the first assembly's */
  MECHKIN_GOES_ON = 0,      /* they come to the last one */
  MECHKIN_DEAD_CENTRE = 1,
  MECHKIN_BRANCH_POINT = 2,
  MECHKIN_UNKNOWN = 3
} mechkin_stop;

/* The rows of one variant, on the branch that leads to the file's own; nan outside of [first, last). The power error is
 * there where the variants demand it, the condition likewise. */
typedef struct mechkin_variant {
  double* values;      /* values x variant_rows, SI, angles with their whole turns */
  double* residual;    /* variant_rows */
  double* condition;   /* variant_rows */
  double* power_error; /* variant_rows, optional */
  double* stopped;     /* 2 x inputs, optional: where the inputs stop before and behind the rows, as they are given */
  mechkin_end end;
  size_t first, last;    /* the rows that are closed */
  mechkin_stop stops[2]; /* before and behind them */
} mechkin_variant;

/* Runs the plan's variant with some parameters (SI); what became of it is in `end`. One at a time for each plan. */
MECHKIN_API mechkin_status mechkin_run_variant(const mechkin_plan* plan, const double* parameters, mechkin_variant* variant,
                                               mechkin_message* message);

/* The rows of a response with other parameters: its first assembly is continued from the base's; nan where the motion did
 * not come. It is complete where it came to its last row, or to a stop. */
typedef struct mechkin_response {
  double* values;      /* values x variant_rows, SI, angles with their whole turns */
  double* residual;    /* variant_rows */
  double* condition;   /* variant_rows */
  double* power_error; /* variant_rows */
  double* work;        /* 2 x variant_rows: put in and lost since the first row, J */
  mechkin_end end;
  size_t rows;         /* of its table: all, or up to a stop */
  size_t reached;      /* of these */
  size_t moments;      /* of the base's that were reached: a stop's own row may be one more */
  int stop;            /* number of the stop that ended it, -1: none */
  double time;         /* s: how far it came */
  double energy;       /* J: the largest kinetic energy at the ends of its steps */
} mechkin_response;

/* Runs a response: `start` is the plan of its first moment with what variants of it have in common, `motion` that of the
 * free motion. One at a time for each plan. */
MECHKIN_API mechkin_status mechkin_run_response(const mechkin_plan* start, const mechkin_plan* motion, const double* parameters,
                                                mechkin_response* response, mechkin_message* message);

/* A tape by itself, which computes cells of a table from a row's quantities. */
typedef struct mechkin_tape mechkin_tape;

MECHKIN_API mechkin_status mechkin_tape_create(const char* text, size_t length, mechkin_tape** tape,
                                               mechkin_message* message);
MECHKIN_API void mechkin_tape_free(mechkin_tape* tape); /* or null */
MECHKIN_API size_t mechkin_tape_inputs(const mechkin_tape* tape);
MECHKIN_API size_t mechkin_tape_outputs(const mechkin_tape* tape);
/* inputs x count to outputs x count, a column contiguous; `other_way` (count), or null, tells where a guard failed. */
MECHKIN_API mechkin_status mechkin_tape_run(const mechkin_tape* tape, size_t count, const double* inputs, double* outputs,
                                            unsigned char* other_way, mechkin_message* message);

typedef enum mechkin_notation {
  MECHKIN_SHORTEST = 0,  /* that reads back as the same double */
  MECHKIN_FIXED = 1,     /* with so many decimals */
  MECHKIN_TRIMMED = 2,   /* the same without the zeros that end every number */
  MECHKIN_SCIENTIFIC = 3 /* a digit, so many decimals, an exponent */
} mechkin_notation;

/* The texts of a column's cells, each ended by a line feed; what is not finite has none. Returns their size, which is
 * written where there is room for it, 0 where memory ran out. */
MECHKIN_API size_t mechkin_cell_texts(const double* numbers, size_t rows, mechkin_notation notation, unsigned digits,
                                      char* text, size_t room);

#ifdef __cplusplus
}
#endif

#endif
