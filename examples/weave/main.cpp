// SPDX-License-Identifier: MIT
#include "../support/program.hpp"

example::Program weave_program();

int main(int argc, char** argv) { return example::run(argc, argv, weave_program()); }
