#include "files/read/stamps.hpp"

#include "support/catch.hpp"

using namespace pirsim;
using io::parse_stamp, io::Stamp;

namespace {

constexpr std::int64_t second = 1'000'000;

/// Of a text that says a moment or a time of day.
std::int64_t us(std::string_view text, Dates order = Dates::found) {
  const auto stamp = parse_stamp(text, order);
  REQUIRE(stamp);
  CHECK(stamp->kind != Stamp::Kind::number);
  return stamp->us;
}

}  // namespace

TEST_CASE("moments as loggers write them") {
  // `date -u -d '2025-04-06T18:00:01Z' +%s` is 1743962401.
  constexpr std::int64_t moment = 1743962401 * second;
  CHECK(us("2025-04-06T18:00:01") == moment);
  CHECK(us("2025-04-06 18:00:01.5") == moment + second / 2);
  CHECK(us("2025-04-06 18:00:01,345678912") == moment + 345678);
  CHECK(us("2025/04/06 18:00:01") == moment);
  CHECK(us("2025-4-6 18:00:01") == moment);
  CHECK(us("06.04.2025 18:00:01") == moment);
  CHECK(us("04/06/2025 6:00:01 PM") == moment);
  CHECK(us("04/06/25 18:00:01", Dates::month_first) == moment);
  CHECK(us("06/04/2025 18:00:01", Dates::day_first) == moment);
  CHECK(us(" 2025-04-06 18:00 ") == moment - second);
  CHECK(us("2025-04-06T18:00:01.000Z") == moment);
  CHECK(us("2025-04-06T20:00:01+02:00") == moment);
  CHECK(us("2025-04-06T20:00:01 +0200") == moment);
  CHECK(us("2025-04-06 12:30:01-05:30") == moment);
  CHECK(us("2025-04-06 18:00:01 UTC") == moment);
  CHECK(us("4/6/2025, 6:00:01 PM") == moment);
  CHECK(us("4/6/2025, 6:00:01\xE2\x80\xAFPM") == moment);
  CHECK(us("6.4.2025, 18:00:01") == moment);
  CHECK(parse_stamp("2025-04-06T20:00:01+02:00", Dates::found)->offset_s == 7200);
  CHECK(us("2010-11-04 00:03:50.209589") == 1288829030 * second + 209589);
}

TEST_CASE("times of day, as spreadsheets leave them") {
  CHECK(us("0:00:34") == 34 * second);
  CHECK(us("10:49:41 AM") == (10 * 3600 + 49 * 60 + 41) * second);
  CHECK(us("12:00:00 AM") == 0);
  CHECK(us("12:30:00pm") == (12 * 3600 + 1800) * second);
  CHECK(us("1:02") == 3720 * second);
  CHECK(us("24:00:00") == 86400 * second);
}

TEST_CASE("numbers, also with a decimal comma") {
  CHECK(parse_stamp("1743962401", Dates::found)->number == 1743962401.0);
  CHECK(parse_stamp("1,5", Dates::found)->number == 1.5);
  CHECK(parse_stamp("-3", Dates::found)->kind == Stamp::Kind::number);
}

TEST_CASE("what is no time") {
  for (const char* text :
       {"", "on", "2025-02-30T10:00", "2025-13-01", "2025-04-06T25:00", "24:00:01", "10:60:00", "13:00 PM", "0:30 AM x",
        "2025-04-06T18:00:01+15:00", "2025-04-06T18:00:01 Mars", "2025-04-06T", "1e999", "31/31/2025 10:00",
        "99999-01-01T00:00", "inf", "nan", "2025-04-06T18:0:01"})
    CHECK_FALSE(parse_stamp(text, Dates::found));
}

TEST_CASE("the order of day and month, where the date tells it") {
  const auto order = [](const char* text) { return io::order_of_date(text).value().order; };
  CHECK(order("12/22/2017 0:00") == Dates::month_first);
  CHECK(order("22/12/2017") == Dates::day_first);
  CHECK(order("01.02.2017") == Dates::day_first);
  CHECK(order("01/02/2017") == Dates::found);
  CHECK_FALSE(io::order_of_date("2017/01/02"));
  // Of two digits, the year may be first.
  for (const char* text : {"26-05-14", "14.05.26", "14/05/26", "01/02/26"}) CHECK(order(text) == Dates::found);
  CHECK(order("5/14/26") == Dates::month_first);
  CHECK(order("32-05-14") == Dates::year_first);
  CHECK(order("14.05.32") == Dates::day_first);
  const auto us = [](const char* text, Dates dates) { return parse_stamp(text, dates).value().us; };
  CHECK(us("26-05-14 06:00", Dates::year_first) == us("2026-05-14 06:00", Dates::found));
  CHECK(us("26-05-14 06:00", Dates::day_first) == us("2014-05-26 06:00", Dates::found));
  CHECK(us("20260514 06:00", Dates::found) == us("2026-05-14 06:00", Dates::found));
}
