// SPDX-License-Identifier: MIT
#include "refusal.hpp"

#include <fibrant/observe/json.hpp>

#include <doctest/doctest.h>

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

using namespace fibrant;

namespace json_test {

using namespace fibrant::observe;

TEST_CASE("an object lists its values in the order in which they came") {
    JsonObject inner;
    inner.add("search", 0.5).add("solution", 2);
    JsonObject object;
    object.add("converged", true)
        .add("fibres", std::ptrdiff_t{152})
        .add("memory", std::int64_t{1} << 40)
        .add("name", "plain")
        .add("seconds", inner)
        .add("crimp", std::vector<double>{0.25, 1e-3})
        .add("rows", std::vector<JsonObject>{JsonObject{}.add("a", 1), JsonObject{}});
    CHECK(object.text() == R"({
  "converged": true,
  "fibres": 152,
  "memory": 1099511627776,
  "name": "plain",
  "seconds": {
    "search": 0.5,
    "solution": 2
  },
  "crimp": [0.25, 0.001],
  "rows": [
    {
      "a": 1
    },
    {}
  ]
})");
    CHECK(JsonObject{}.text() == "{}");
}

TEST_CASE("what is not a finite number is null, for JSON has no other word") {
    JsonObject object;
    object.add("a", std::numeric_limits<double>::quiet_NaN()).add("b", -std::numeric_limits<double>::infinity());
    CHECK(object.text() == "{\n  \"a\": null,\n  \"b\": null\n}");
}

TEST_CASE("a text is escaped, and bytes that are not UTF-8 are replaced") {
    CHECK(json_quoted("a\"b\\c\n\t\x01") == R"("a\"b\\c\n\t\u0001")");
    CHECK(json_quoted("m\xc3\xbctze \xe2\x82\xac \xf0\x9f\xa7\xb6") == "\"m\xc3\xbctze \xe2\x82\xac \xf0\x9f\xa7\xb6\"");
    CHECK(json_quoted("\xff") == R"("\ufffd")");
    CHECK(json_quoted("\xc0\xaf") == R"("\ufffd\ufffd")");            // overlong
    CHECK(json_quoted("\xed\xa0\x80") == R"("\ufffd\ufffd\ufffd")");  // a surrogate
    CHECK(json_quoted("cut \xe2\x82") == R"("cut \ufffd\ufffd")");
}

TEST_CASE("a key is given once") {
    JsonObject object;
    object.add("a", 1);
    CHECK(test::refusal([&] { object.add("a", 2); }) == "JsonObject.key = a, but it must be new in the object");
}

}  // namespace json_test
