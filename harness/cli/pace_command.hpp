// whirl bench pace: how steady a kilohertz this host holds, and what the bench's loop adds to that.
//
//   Arms      an empty loop that only sleeps to each millisecond, and the bench's own loop (BenchTarget without links),
//             in turns of five seconds, so that both see the same minutes of the machine
//   Judged    the share of steps later than `late`: the bench's may be more than the empty loop's by 0.1 % of the steps
//   Overload  so many threads that are scheduled before it burn 30 % of the time: the bench's arm must then call itself
//             inconclusive, as a run would
#pragma once

namespace whirl::cli {

struct PaceOptions {
  double seconds = 60.0;  // of each arm
  double late_us = 200.0;
  int overload = 0;
};

// 0: it holds; 1: it does not; 2: bad input; 3: without SCHED_FIFO, or overloaded: inconclusive
int bench_pace_command(const PaceOptions& options);

}  // namespace whirl::cli
