// SPDX-License-Identifier: MIT
#include "../support/program.hpp"

example::Program fabric_loading_program();

int main(int argc, char** argv) { return example::run(argc, argv, fabric_loading_program()); }
