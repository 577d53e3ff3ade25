// What a page calls besides the interface in C: the same with numbers instead of structs, which JavaScript would have to
// lay out.
#include <cstring>

#include "mechkin.h"

extern "C" {

// inputs, values, parameters, variant_rows: four numbers.
void mechkin_page_sizes(const mechkin_plan* plan, double* to) {
  const mechkin_sizes sizes = mechkin_plan_sizes(plan);
  to[0] = (double)sizes.inputs, to[1] = (double)sizes.values;
  to[2] = (double)sizes.parameters, to[3] = (double)sizes.variant_rows;
}

// Runs a variant: values, residual, condition and power error one behind the other in `rows`; in `told` end, first, last,
// both stops, then 2 x inputs where it stops.
int mechkin_page_run(const mechkin_plan* plan, const double* parameters, double* rows, double* told, char* message) {
  const mechkin_sizes sizes = mechkin_plan_sizes(plan);
  mechkin_variant variant = {};
  const size_t count = sizes.variant_rows;
  variant.values = rows;
  variant.residual = rows + sizes.values * count;
  variant.condition = variant.residual + count;
  variant.power_error = variant.condition + count;
  variant.stopped = told + 5;
  mechkin_message why;
  const mechkin_status status = mechkin_run_variant(plan, parameters, &variant, &why);
  std::memcpy(message, why.text, sizeof why.text);
  told[0] = variant.end, told[1] = (double)variant.first, told[2] = (double)variant.last;
  told[3] = variant.stops[0], told[4] = variant.stops[1];
  return status;
}

// Runs a response: the same columns in `rows`, then the two of its work; in `told` end, rows, reached, stop, time,
// energy, moments.
int mechkin_page_respond(const mechkin_plan* start, const mechkin_plan* motion, const double* parameters, double* rows,
                         double* told, char* message) {
  const mechkin_sizes sizes = mechkin_plan_sizes(motion);
  mechkin_response response = {};
  const size_t count = sizes.variant_rows;
  response.values = rows;
  response.residual = rows + sizes.values * count;
  response.condition = response.residual + count;
  response.power_error = response.condition + count;
  response.work = response.power_error + count;
  mechkin_message why;
  const mechkin_status status = mechkin_run_response(start, motion, parameters, &response, &why);
  std::memcpy(message, why.text, sizeof why.text);
  told[0] = response.end, told[1] = (double)response.rows, told[2] = (double)response.reached;
  told[3] = response.stop, told[4] = response.time, told[5] = response.energy, told[6] = (double)response.moments;
  return status;
}

}
