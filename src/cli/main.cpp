// etendue: the command line.
#include "cli/program.h"

int main(int argc, char** argv) {
    return etendue::run_program(argc, argv);
}
