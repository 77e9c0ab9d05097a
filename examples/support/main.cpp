// SPDX-License-Identifier: MIT
// The command line of a program that reads a scene. FIBRANT_PROGRAM is the function that tells which, such as weave_program.
#include "program.hpp"

example::Program FIBRANT_PROGRAM();

int main(int argc, char** argv) { return example::run(argc, argv, FIBRANT_PROGRAM()); }
