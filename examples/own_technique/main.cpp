// Gnomon's command line, with the passes of this program besides its own.
#include "tools/cli.h"

int main(int argc, char** argv) { return gnomon::run_cli(argc, argv); }
