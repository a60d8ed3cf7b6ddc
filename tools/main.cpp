#include "tools/cli.h"

int main(int argc, char** argv) { return gnomon::run_cli(argc, argv); }
