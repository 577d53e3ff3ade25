#include "rows/threads.hpp"

#if MECHKIN_ONE_THREAD  // WebAssembly in a page: the caller does all

void over_rows(long rows, long, int, const std::function<void(long, long, int)>& work) {
  if (rows > 0) work(0, rows, 0);
}

int available_processors() { return 1; }

#else

#include <atomic>
#include <condition_variable>
#include <cstdlib>
#include <exception>
#include <list>
#include <mutex>
#include <thread>
#include <vector>

#include "rows/units.hpp"

#if defined(__unix__) || defined(__APPLE__)
#include <pthread.h>
#include <signal.h>
#endif
#if defined(__linux__)
#include <sched.h>
#endif

namespace {

// What stopped some work, or null.
#ifdef __cpp_exceptions
using Failure = std::exception_ptr;
template <class Work>
Failure attempt(const Work& work) {
  try {
    work();
  } catch (...) {
    return std::current_exception();
  }
  return nullptr;
}
void pass_on(const Failure& failure) {
  if (failure) std::rethrow_exception(failure);
}
#else
using Failure = const void*;
template <class Work>
Failure attempt(const Work& work) {
  work();
  return nullptr;
}
void pass_on(Failure) {}
#endif

// Rows of one call; threads come and take chunks until none is left.
struct Job {
  const std::function<void(long, long, int)>& work;
  long rows, chunk;
  int places;                 // threads that may still come
  int inside = 0;             // pool threads that work on it; guarded by the pool
  std::atomic<long> next{0};  // first row that nobody has taken
  std::atomic<int> thread{0};
  std::atomic<bool> failed{false};
  Failure failure = nullptr;  // the first one; written by the thread that set `failed`

  // Throws nothing: a pool's thread has nobody to tell, and the caller must wait for the others first.
  void take_chunks() noexcept {
    const int number = thread.fetch_add(1);
    const Failure stopped = attempt([&] {
      for (long begin; !failed && (begin = next.fetch_add(chunk)) < rows;)
        work(begin, begin + chunk < rows ? begin + chunk : rows, number);
    });
    if (stopped && !failed.exchange(true)) failure = stopped;
  }
};

class Pool {
 public:
  void run(Job& job) {
    {
      std::lock_guard<std::mutex> lock(mutex_);
      if (!stopped_) {
        grow(job.places);
        jobs_.push_back(&job);
      }
    }
    wake_.notify_all();
    job.take_chunks();
    std::unique_lock<std::mutex> lock(mutex_);
    jobs_.remove(&job);
    left_.wait(lock, [&] { return job.inside == 0; });
    pass_on(job.failure);
  }

  void stop() {
    {
      std::lock_guard<std::mutex> lock(mutex_);
      stopped_ = true;
    }
    wake_.notify_all();
    for (std::thread& t : threads_) t.join();
    threads_.clear();
  }

 private:
  void grow(int wanted) {
    [[maybe_unused]] SignalsBlocked blocked;
    // where no more are to be had, those that are there do the work
    (void)attempt([&] {
      while ((int)threads_.size() < wanted) threads_.emplace_back([this] { serve(); });
    });
  }

  void serve() {
    FloatingPointState state;
    std::unique_lock<std::mutex> lock(mutex_);
    for (;;) {
      wake_.wait(lock, [this] { return stopped_ || !jobs_.empty(); });
      if (stopped_) return;
      Job* const job = jobs_.front();
      ++job->inside;
      if (--job->places == 0) jobs_.pop_front();
      lock.unlock();
      job->take_chunks();
      lock.lock();
      // no chunk is left for others to come for
      jobs_.remove(job);
      if (--job->inside == 0) left_.notify_all();
    }
  }

  // Signals are for the threads of the program; a new thread inherits the mask.
  struct SignalsBlocked {
#if defined(__unix__) || defined(__APPLE__)
    sigset_t before;
    SignalsBlocked() {
      sigset_t every;
      sigfillset(&every);
      pthread_sigmask(SIG_SETMASK, &every, &before);
    }
    ~SignalsBlocked() { pthread_sigmask(SIG_SETMASK, &before, nullptr); }
#endif
  };

  std::mutex mutex_;
  std::condition_variable wake_, left_;
  std::list<Job*> jobs_;
  std::vector<std::thread> threads_;
  bool stopped_ = false;
};

// Never destroyed: a thread of the program may still be in a call while the process ends.
std::atomic<Pool*> the_pool{nullptr};

void stop_pool() {
  if (Pool* pool = the_pool.load()) pool->stop();
}

// A child has no threads but the one that forked, and locks as they stood: it starts anew.
[[maybe_unused]] void forget_pool() { the_pool.store(nullptr); }

Pool& pool() {
  static const bool prepared = [] {
#if defined(__unix__) || defined(__APPLE__)
    pthread_atfork(nullptr, nullptr, forget_pool);
#endif
    std::atexit(stop_pool);
    return true;
  }();
  (void)prepared;
  Pool* found = the_pool.load();
  if (found) return *found;
  Pool* made = new Pool;
  if (the_pool.compare_exchange_strong(found, made)) return *made;
  delete made;
  return *found;
}

}  // namespace

void over_rows(long rows, long chunk, int threads, const std::function<void(long, long, int)>& work) {
  const long chunks = (rows + chunk - 1) / chunk;
  if (threads > chunks) threads = (int)chunks;
  if (threads < 2) {
    if (rows > 0) work(0, rows, 0);
    return;
  }
  Job job{work, rows, chunk, threads - 1};
  pool().run(job);
}

int available_processors() {
#if defined(__linux__)
  cpu_set_t set;
  if (sched_getaffinity(0, sizeof set, &set) == 0) return CPU_COUNT(&set);
#endif
  const unsigned count = std::thread::hardware_concurrency();
  return count ? (int)count : 1;
}

#endif
