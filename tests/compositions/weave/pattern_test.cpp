// SPDX-License-Identifier: MIT
#include "refusal.hpp"

#include <fibrant/compositions/weave/pattern.hpp>

#include <doctest/doctest.h>

#include <random>
#include <string>
#include <vector>

using namespace fibrant;

namespace pattern_test {

using namespace fibrant::compositions::weave;

std::vector<std::string> drawn(const Pattern& pattern) {
    std::vector<std::string> rows;
    for (Index i = 0; i < pattern.rows(); ++i) {
        rows.emplace_back();
        for (Index j = 0; j < pattern.columns(); ++j) rows.back() += pattern.over(i, j) ? '1' : '0';
    }
    return rows;
}

TEST_CASE("the built-in weaves are those that are drawn on point paper") {
    CHECK(drawn(Pattern::named("plain")) == std::vector<std::string>{"01", "10"});
    CHECK(drawn(Pattern::named("twill22")) == std::vector<std::string>{"1100", "1001", "0011", "0110"});
    CHECK(drawn(Pattern::named("twill31")) == std::vector<std::string>{"1110", "1101", "1011", "0111"});
    CHECK(drawn(Pattern::named("satin5")) == std::vector<std::string>{"10000", "00100", "00001", "01000", "00010"});
    CHECK(drawn(Pattern::named("satin8")) == std::vector<std::string>{"10000000", "00010000", "00000010", "01000000", "00001000",
                                                                      "00000001", "00100000", "00000100"});
}

TEST_CASE("a satin has one crossing of each tow in a repeat, and no two of them touch") {
    for (const char* name : {"satin5", "satin8"}) {
        const Pattern satin = Pattern::named(name);
        const Index n = satin.rows();
        for (Index i = 0; i < n; ++i) {
            Index in_row = 0, in_column = 0;
            for (Index j = 0; j < n; ++j) {
                in_row += satin.over(i, j);
                in_column += satin.over(j, i);
                if (satin.over(i, j)) {
                    CHECK_FALSE(satin.over(i, j + 1));
                    CHECK_FALSE(satin.over(i + 1, j));
                    CHECK_FALSE(satin.over(i + 1, j + 1));
                    CHECK_FALSE(satin.over(i + 1, j + n - 1));
                }
            }
            CHECK(in_row == 1);
            CHECK(in_column == 1);
        }
    }
}

TEST_CASE("a weave repeats in both directions") {
    const Pattern twill = Pattern::named("twill31");
    for (Index i = 0; i < 4; ++i)
        for (Index j = 0; j < 4; ++j) {
            CHECK(twill.over(i + 4, j) == twill.over(i, j));
            CHECK(twill.over(i, j + 8) == twill.over(i, j));
        }
}

TEST_CASE("a matrix may be drawn with digits or with words") {
    const Pattern digits = Pattern::from_rows({"10 1", "010"});
    const Pattern words = Pattern::from_rows({"over under over", "under,over, under"});
    CHECK(drawn(digits) == std::vector<std::string>{"101", "010"});
    CHECK(drawn(words) == drawn(digits));
    CHECK_FALSE(digits.built_in());
}

TEST_CASE("a matrix that is not one is refused with the row that is wrong") {
    using test::refusal;
    CHECK(refusal([] { Pattern::from_rows({}); }) == "Pattern.rows = [], but it must be at least one row");
    CHECK(refusal([] {
              Pattern::from_rows({"10", "1"});
          }) == "Pattern.rows[1] = \"1\", but it must be as long as the first row, 2");
    CHECK(refusal([] {
              Pattern::from_rows({"10", "12"});
          }) == "Pattern.rows = \"12\", but it must be made of '0' and '1', or of \"over\" and \"under\"");
    CHECK(refusal([] { Pattern::from_rows({" "}); }) == "Pattern.rows[0] = \" \", but it must be at least one crossing");
    CHECK(refusal([] { Pattern::named("tweed"); }) ==
          "Pattern.name = \"tweed\", but it must be plain, twill22, twill31, satin5 or satin8");
}

TEST_CASE("every built-in weave holds on one repeat of tows, and a drawn one on whole repeats only") {
    for (const char* name : {"plain", "twill22", "twill31", "satin5", "satin8"}) {
        const Pattern pattern = Pattern::named(name);
        CHECK_NOTHROW(pattern.require_holding(pattern.rows(), pattern.columns()));
    }
    CHECK_NOTHROW(Pattern::named("plain").require_holding(5, 3));
    const Pattern drawn = Pattern::from_rows({"01", "10"});
    CHECK_NOTHROW(drawn.require_holding(4, 6));
    CHECK(test::refusal([&] { drawn.require_holding(5, 4); }) ==
          "Pattern.size = 2 x 2, but it must be a divisor of the tow counts, 5 warp x 4 weft");
}

TEST_CASE("a tow that never changes side lifts off, so the interlacing is refused by the tow's name") {
    const std::string message = test::refusal([] { Pattern::from_rows({"010", "111", "101"}).require_holding(3, 3); });
    CHECK(message.find("warp 1 (above)") != std::string::npos);
    CHECK(test::refusal([] { Pattern{}.require_holding(1, 4); }).find("an interlacing that holds") != std::string::npos);
}

TEST_CASE("two cloths that lie on each other are refused though every tow changes side") {
    // Warp 0, 1 and weft 0, 1 are a plain weave; so are warp 2, 3 and weft 2, 3; the first lies above the second.
    const Pattern layers = Pattern::from_rows({"0111", "1011", "0001", "0010"});
    for (Index i = 0; i < 4; ++i) {
        bool over = false, under = false;
        for (Index j = 0; j < 4; ++j) (layers.over(i, j) ? over : under) = true;
        CHECK(over);
        CHECK(under);
    }
    const std::string loose = layers.loose_tows(4, 4);
    CHECK(loose == "warp 0, warp 1, weft 0, weft 1 (above)");
    CHECK(test::refusal([&] { layers.require_holding(4, 4); }).find(loose) != std::string::npos);
}

TEST_CASE("holding together is decided as by trying every set of tows") {
    std::mt19937 random(5);
    int held = 0, loose = 0;
    for (int trial = 0; trial < 300; ++trial) {
        std::vector<std::string> rows(4, std::string(4, '0'));
        for (std::string& row : rows)
            for (char& cell : row) cell = random() % 2 == 0 ? '0' : '1';
        const Pattern pattern = Pattern::from_rows(rows);
        // Some set, neither empty nor all, whose tows lie above all others wherever they cross.
        bool separable = false;
        for (unsigned set = 1; set < 255 && !separable; ++set) {
            bool above = true;
            for (Index i = 0; i < 4 && above; ++i)
                for (Index j = 0; j < 4 && above; ++j) {
                    const bool warp = (set >> i & 1u) != 0, weft = (set >> (4 + j) & 1u) != 0;
                    if (warp && !weft) above = pattern.over(i, j);
                    if (weft && !warp) above = !pattern.over(i, j);
                }
            separable = above;
        }
        CHECK(separable == !pattern.loose_tows(4, 4).empty());
        (separable ? loose : held) += 1;
    }
    CHECK(held > 20);
    CHECK(loose > 20);
}

}  // namespace pattern_test
