// SPDX-License-Identifier: MIT
#include "../support/program.hpp"

example::Program two_ply_program();

int main(int argc, char** argv) { return example::run(argc, argv, two_ply_program()); }
