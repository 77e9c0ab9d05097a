// SPDX-License-Identifier: MIT
#include "observe/snapshot_samples.hpp"
#include "refusal.hpp"

#include <fibrant/observe/csv_writer.hpp>

#include <doctest/doctest.h>

#include <limits>
#include <string>

using namespace fibrant;

namespace csv_writer_test {

using namespace fibrant::observe;

TEST_CASE("the header is written once and each row is in the file as soon as it is given") {
    const auto path = empty_folder("csv_rows") / "table.csv";
    CsvWriter table(path);
    table.row({{"increment", 1}, {"stage", "pull"}, {"gap", 0.1}, {"open", true}});
    CHECK(read_file(path) == "increment,stage,gap,open\n1,pull,0.1,1\n");
    table.row({{"increment", 2}, {"stage", "pull, \"hard\""}, {"gap", -1e-300}, {"open", false}});
    CHECK(read_file(path) == "increment,stage,gap,open\n1,pull,0.1,1\n2,\"pull, \"\"hard\"\"\",-1e-300,0\n");
}

TEST_CASE("a number in the table reads back to the same bits") {
    for (const double value : {0.1, 1.0 / 3.0, 6.02214076e23, std::numeric_limits<double>::denorm_min(), -0.0})
        CHECK(std::strtod(Column("x", value).value.c_str(), nullptr) == value);
    CHECK(Column("x", std::numeric_limits<double>::quiet_NaN()).value == "nan");
}

TEST_CASE("a resumed table keeps earlier rows, and drops repeated ones and one that was cut off") {
    const auto path = empty_folder("csv_resume") / "table.csv";
    write_file(path, "increment,value\n1,10\n2,20\n3,30\n4,4");
    CsvWriter table(path, Start::resumed);
    table.row({{"increment", 3}, {"value", 33}});
    table.row({{"increment", 4}, {"value", 44}});
    CHECK(read_file(path) == "increment,value\n1,10\n2,20\n3,33\n4,44\n");
    CsvWriter anew(path);
    anew.row({{"increment", 1}, {"value", 0}});
    CHECK(read_file(path) == "increment,value\n1,0\n");
}

TEST_CASE("a resumed table begins anew where there is no file yet") {
    const auto path = empty_folder("csv_absent") / "table.csv";
    CsvWriter table(path, Start::resumed);
    table.row({{"increment", 5}});
    CHECK(read_file(path) == "increment\n5\n");
}

TEST_CASE("rows of other columns are refused") {
    const auto path = empty_folder("csv_columns") / "table.csv";
    CsvWriter table(path);
    table.row({{"a", 1}, {"b", 2}});
    CHECK(test::refusal([&] {
              table.row({{"a", 1}, {"c", 2}});
          }) == "CsvWriter.columns = a,c, but it must be those of the first row, a,b");
    CsvWriter twice(path);
    CHECK(test::refusal([&] {
              twice.row({{"a", 1}, {"b", 2}, {"a", 3}});
          }) == "CsvWriter.columns = a, but it must be a name that no other column has");
    CsvWriter resumed(path, Start::resumed);
    CHECK(test::refusal([&] { resumed.row({{"a", 1}}); }).find("CsvWriter.columns = a, but it must be those of") == 0);
}

}  // namespace csv_writer_test
