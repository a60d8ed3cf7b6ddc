// The program `gnomon`.
#include <csignal>

#include "tools/cli.h"

int main(int argc, char** argv) {
  std::signal(SIGXFSZ, SIG_IGN);  // a file-size limit is an error like a full disk
  return gnomon::run_cli(argc, argv);
}
