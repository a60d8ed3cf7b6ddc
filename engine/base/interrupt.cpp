// Ending early and cleanly when somebody asks by a signal.
#include "engine/base/interrupt.h"

#include <unistd.h>

#include <csignal>

namespace gnomon {
namespace {

volatile std::sig_atomic_t remembered = 0;  // a handler has no other way to tell

extern "C" void remember(int signal) {
  constexpr int killed = 128;  // as shells report it
  if (remembered != 0) _exit(killed + signal);
  remembered = signal;
}

}  // namespace

void remember_interrupts() {
  struct sigaction action {};
  action.sa_handler = remember;  // without SA_RESTART: a wait ends, so that its caller can look
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

void check_interrupt() {
  if (remembered != 0) throw Interrupted{remembered};
}

}  // namespace gnomon
