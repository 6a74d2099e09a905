// The program ndhull-bench: measurements that anybody can repeat on a machine of their own.
#include "bench/program.h"

int main(int argc, char** argv) { return ndhull::run_bench(argc, argv); }
