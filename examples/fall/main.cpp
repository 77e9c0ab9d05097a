// SPDX-License-Identifier: MIT
#include "../support/program.hpp"

example::Program fall_program();

int main(int argc, char** argv) { return example::run(argc, argv, fall_program()); }
