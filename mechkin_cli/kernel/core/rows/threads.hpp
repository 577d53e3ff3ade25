// Rows over threads: a pool of the kernel's own, made when it is first needed.
//
// What a row gets does not depend on the cut, so the bytes are the same for every number of threads. A forked child
// makes a pool of its own; at exit the threads are joined.
#pragma once

#include <functional>

// Calls work(begin, end, thread) until all rows [0, rows) are done, `chunk` rows at a time; `thread` is below
// `threads` and no two calls at the same time have the same. The caller works, too, and returns when all is done.
// Where fewer threads can be had than asked for, the others do more. Where memory runs out in one of them, that comes out
// here, once all have ended.
void over_rows(long rows, long chunk, int threads, const std::function<void(long, long, int)>& work);

// Processors that this process may use.
int available_processors();
