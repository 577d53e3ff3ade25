/* Runs rows, and responses, by the interface in C: c_runs PLAN GIVEN FOUND, or c_runs START MOTION GIVEN FOUND.
 *
 * Of rows, GIVEN: int64 rows, demand, iterations, threads, with parameters or not, which given arrays there are (bits, in the order
 * of mechkin_rows) and which found ones are asked for (likewise, after those that always are); then doubles: tight, coarse,
 * accept, size, the parameters, the given arrays. FOUND: the constants, then the found arrays in their order.
 *
 * Of a response, GIVEN: the parameters. FOUND: int64 end, rows, reached, moments, stop; then doubles: time, energy, and the
 * found arrays in their order. */
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "mechkin.h"

static void stop(const char* what, const char* why) {
  fprintf(stderr, "%s: %s\n", what, why);
  exit(1);
}

static void check(const char* what, mechkin_status status, const mechkin_message* message) {
  if (status == MECHKIN_OTHER_WAY) exit(2);
  if (status != MECHKIN_OK) stop(what, message->text);
}

/* Filled with a byte that no run writes into every place: what is left unwritten shows. */
static void* allocate(size_t size) {
  void* memory = malloc(size ? size : 1);
  if (!memory) stop("memory", "none");
  return memset(memory, 0xa5, size);
}

static double* numbers(FILE* file, size_t count) {
  double* read = allocate(count * sizeof *read);
  if (fread(read, sizeof *read, count, file) != count) stop("given", "too short");
  return read;
}

static char* whole_text(const char* name, size_t* length) {
  FILE* file = fopen(name, "rb");
  char* text;
  if (!file) stop(name, "not there");
  fseek(file, 0, SEEK_END);
  *length = (size_t)ftell(file);
  rewind(file);
  text = allocate(*length);
  if (fread(text, 1, *length, file) != *length) stop(name, "too short");
  fclose(file);
  return text;
}

static mechkin_plan* plan_of(const char* name) {
  mechkin_message message;
  mechkin_plan* plan;
  size_t length;
  char* text = whole_text(name, &length);
  check("plan", mechkin_plan_create(text, length, &plan, &message), &message);
  free(text);
  return plan;
}

/* names: the program, PLAN, GIVEN, FOUND */
static void run_rows(char** names) {
  enum { ROWS, DEMAND, ITERATIONS, THREADS, VARIED, GIVEN, FOUND, HEAD };
  int64_t head[HEAD];
  mechkin_message message;
  mechkin_plan* plan;
  mechkin_sizes sizes;
  mechkin_rows rows;
  size_t k;
  double* tests;
  FILE *given, *found;
  plan = plan_of(names[1]);
  sizes = mechkin_plan_sizes(plan);

  given = fopen(names[2], "rb");
  if (!given || fread(head, sizeof *head, HEAD, given) != HEAD) stop(names[2], "no head");
  memset(&rows, 0, sizeof rows);
  rows.rows = (size_t)head[ROWS], rows.demand = (unsigned)head[DEMAND];
  rows.iterations = (int)head[ITERATIONS], rows.threads = (int)head[THREADS];
  tests = numbers(given, 4);
  rows.tight = tests[0], rows.coarse = tests[1], rows.accept = tests[2];
  if (head[VARIED]) {
    double* parameters = numbers(given, sizes.parameters);
    check("parameters", mechkin_plan_set_parameters(plan, parameters, NULL, &message), &message);
    free(parameters);
  }
  check("size", mechkin_plan_set_size(plan, tests[3], &message), &message);
  {
    const double** arrays[] = {&rows.inputs, &rows.guess,  &rows.rates, &rows.accelerations, &rows.jerks,
                               &rows.constraint_rates,   &rows.turned, &rows.whole, &rows.full,          &rows.time};
    const size_t columns[] = {sizes.inputs, sizes.states, sizes.inputs, sizes.inputs, sizes.inputs,
                              sizes.input_constraints,   sizes.turns,  sizes.inputs, sizes.inputs, 1};
    for (k = 0; k < sizeof columns / sizeof *columns; ++k)
      if (head[GIVEN] >> k & 1) *arrays[k] = numbers(given, columns[k] * rows.rows);
  }
  {
    double** arrays[] = {&rows.states, &rows.residual, &rows.correction, &rows.values,      &rows.first,
                         &rows.second, &rows.side,     &rows.condition,  &rows.power_error, &rows.loads};
    const size_t columns[] = {sizes.states,  1,            1, sizes.values, sizes.columns,
                              sizes.columns, sizes.blocks, 1, 1,            sizes.loads};
    const size_t always = 3, arrays_count = sizeof columns / sizeof *columns;
    double* constants = allocate(sizes.constants * sizeof *constants);
    for (k = 0; k < arrays_count; ++k)
      if (k < always || head[FOUND] >> (k - always) & 1)
        *arrays[k] = allocate(columns[k] * rows.rows * sizeof(double));
    rows.flags = allocate(rows.rows);
    check("run", mechkin_run(plan, &rows, &message), &message);

    found = fopen(names[3], "wb");
    if (!found) stop(names[3], "cannot be written");
    mechkin_plan_constants(plan, constants);
    fwrite(constants, sizeof *constants, sizes.constants, found);
    for (k = 0; k < arrays_count; ++k)
      if (*arrays[k]) fwrite(*arrays[k], sizeof(double), columns[k] * rows.rows, found);
    fwrite(rows.flags, 1, rows.rows, found);
    if (fclose(found)) stop(names[3], "cannot be written");
  }
  mechkin_plan_free(plan);
}

/* names: the program, START, MOTION, GIVEN, FOUND */
static void run_response(char** names) {
  mechkin_plan *start = plan_of(names[1]), *motion = plan_of(names[2]);
  const mechkin_sizes sizes = mechkin_plan_sizes(motion);
  const size_t rows = sizes.variant_rows;
  mechkin_response response;
  mechkin_message message;
  FILE *given = fopen(names[3], "rb"), *found;
  double* parameters;
  if (!given) stop(names[3], "not there");
  parameters = numbers(given, sizes.parameters);
  memset(&response, 0, sizeof response);
  response.values = allocate(sizes.values * rows * sizeof(double));
  response.residual = allocate(rows * sizeof(double));
  response.condition = allocate(rows * sizeof(double));
  response.power_error = allocate(rows * sizeof(double));
  response.work = allocate(2 * rows * sizeof(double));
  check("response", mechkin_run_response(start, motion, parameters, &response, &message), &message);

  found = fopen(names[4], "wb");
  if (!found) stop(names[4], "cannot be written");
  {
    const int64_t told[] = {(int64_t)response.end, (int64_t)response.rows, (int64_t)response.reached,
                            (int64_t)response.moments, (int64_t)response.stop};
    fwrite(told, sizeof *told, sizeof told / sizeof *told, found);
  }
  fwrite(&response.time, sizeof(double), 1, found);
  fwrite(&response.energy, sizeof(double), 1, found);
  fwrite(response.values, sizeof(double), sizes.values * rows, found);
  fwrite(response.residual, sizeof(double), rows, found);
  fwrite(response.condition, sizeof(double), rows, found);
  fwrite(response.power_error, sizeof(double), rows, found);
  fwrite(response.work, sizeof(double), 2 * rows, found);
  if (fclose(found)) stop(names[4], "cannot be written");
  mechkin_plan_free(start);
  mechkin_plan_free(motion);
}

int main(int count, char** names) {
  if (count == 4)
    run_rows(names);
  else if (count == 5)
    run_response(names);
  else
    stop(names[0], "PLAN GIVEN FOUND, or START MOTION GIVEN FOUND");
  return 0;
}
