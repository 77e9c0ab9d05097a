// SPDX-License-Identifier: MIT
#include "../support/program.hpp"

example::Program knot_program();

int main(int argc, char** argv) { return example::run(argc, argv, knot_program()); }
