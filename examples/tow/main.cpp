// SPDX-License-Identifier: MIT
#include "../support/program.hpp"

example::Program tow_program();

int main(int argc, char** argv) { return example::run(argc, argv, tow_program()); }
