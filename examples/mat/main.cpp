// SPDX-License-Identifier: MIT
#include "../support/program.hpp"

example::Program mat_program();

int main(int argc, char** argv) { return example::run(argc, argv, mat_program()); }
