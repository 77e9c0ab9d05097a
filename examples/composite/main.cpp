// SPDX-License-Identifier: MIT
#include "../support/program.hpp"

example::Program composite_program();

int main(int argc, char** argv) { return example::run(argc, argv, composite_program()); }
