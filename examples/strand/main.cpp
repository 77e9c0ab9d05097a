// SPDX-License-Identifier: MIT
#include "../support/program.hpp"

example::Program strand_program();

int main(int argc, char** argv) { return example::run(argc, argv, strand_program()); }
