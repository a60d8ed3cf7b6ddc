// The program `gnomon`.
#include <csignal>

#include "engine/base/interrupt.h"
#include "tools/cli.h"

int main(int argc, char** argv) {
  std::signal(SIGXFSZ, SIG_IGN);  // a file-size limit is an error like a full disk
  gnomon::remember_interrupts();
  return gnomon::run_cli(argc, argv);
}
