// INT, TERM and HUP: the first one asks the run to end in order, a second one ends the process.
//
//   Scope   the process: whoever waits or loops for long asks interrupted_by() and stops
//   Also    SIGCHLD is set to its default (a parent may have had it ignored, and then no child could
//           be waited for); SIGPIPE and SIGXFSZ are ignored (a reader that went away and a file that
//           may not grow are errors of the write)
#pragma once

namespace whirl {

void catch_interruptions();
// The signal that came; 0: none.
int interrupted_by();
const char* signal_word(int signal);  // "INT"
// For tests: as if it had come, or (0) had not.
void pretend_interruption(int signal);

}  // namespace whirl
