// SPDX-License-Identifier: MIT
#include "../support/program.hpp"

example::Program textile_program();

int main(int argc, char** argv) { return example::run(argc, argv, textile_program()); }
