// Ending early and cleanly when somebody asks by a signal.
#pragma once

namespace gnomon {

// Thrown by check_interrupt(). No std::exception, so that who goes on after one failure does not go on after
// this.
struct Interrupted {
  int signal = 0;  // SIGINT or SIGTERM
};

// From here on the first SIGINT or SIGTERM is remembered for check_interrupt(), a second one ends the process
// at once. Process-wide; for programs, not for libraries.
void remember_interrupts();
// Throws Interrupted when a signal was remembered. Long work calls it between its parts, from any thread.
void check_interrupt();

}  // namespace gnomon
