// What people see on the terminal while plans run and when they have ended.
#pragma once
#include <string>

#include "harness/cli/run_one.hpp"

namespace whirl::cli {

bool is_terminal();  // standard error is one

// A line on standard error that is rewritten in place; nothing where that is no terminal.
ProgressSink progress_line(const std::string& plan);
void clear_progress();

// An error's message on standard error. Returns the exit code that it stands for.
int complain(const Error& error);

// One plan's outcome: a line, and the failed expectations below it.
std::string outcome(const Finished& finished);

// Opens /dev/null where a standard stream is closed, so that no file of ours gets its number. To be
// called first.
void hold_standard_streams();
// At the end: everything printed has arrived. Otherwise says so, and the exit code is at least 3.
int code_with_output(int code);

}  // namespace whirl::cli
