#include "solver/run/ensemble.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#if defined(__linux__) && defined(_OPENMP)
#include <omp.h>
#include <pthread.h>
#include <sched.h>
#endif

namespace myowave::solver {
namespace {

int host_threads() { return Kokkos::DefaultHostExecutionSpace().concurrency(); }

// If OpenMP binds its threads (OMP_PROC_BIND), a new thread of the program is bound to the core of the thread
// that made it. Without this all workers would share the first core.
void go_to_place([[maybe_unused]] int worker) {
#if defined(__linux__) && defined(_OPENMP)
  const int places = omp_get_num_places();
  if (places == 0) return;
  std::vector<int> cores(omp_get_place_num_procs(worker % places));
  omp_get_place_proc_ids(worker % places, cores.data());
  cpu_set_t set;
  CPU_ZERO(&set);
  for (const int core : cores) CPU_SET(core, &set);
  pthread_setaffinity_np(pthread_self(), sizeof set, &set);  // if that fails, the thread stays where it is
#endif
}

}  // namespace

int most_workers() { return own_host_instance(1) ? host_threads() : 1; }

void run_members(std::size_t count, int workers,
                 const std::function<void(std::size_t, const Execution&)>& work) {
  workers = static_cast<int>(std::clamp<std::size_t>(workers, 1, std::max<std::size_t>(1, count)));
  if (workers == 1 || !own_host_instance(1)) {
    for (std::size_t index = 0; index < count; ++index) work(index, {});
    return;
  }
  const int threads = std::max(1, host_threads() / workers);
  std::atomic<std::size_t> next = 0;
  std::mutex first;
  std::exception_ptr failure;
  const auto serve = [&](const Execution& execution) {
    for (std::size_t index = next++; index < count; index = next++) {
      try {
        work(index, execution);
      } catch (...) {
        const std::lock_guard lock(first);
        if (!failure) failure = std::current_exception();
        next = count;
      }
    }
  };
  std::vector<std::jthread> others;
  for (int n = 1; n < workers; ++n)
    others.emplace_back([&, n] {
      go_to_place(n);
      serve(*own_execution(threads));
    });
  serve(*own_execution(threads));
  others.clear();
  if (failure) std::rethrow_exception(failure);
}

}  // namespace myowave::solver
