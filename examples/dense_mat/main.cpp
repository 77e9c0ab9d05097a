// SPDX-License-Identifier: MIT
#include "../support/program.hpp"

example::Program dense_mat_program();

int main(int argc, char** argv) { return example::run(argc, argv, dense_mat_program()); }
