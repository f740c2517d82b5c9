// Prints the tables of columns that pages show, each between its marks. tools/columns/write.py compiles it.
#include <iostream>

#include "pirsim/columns.hpp"

namespace pirsim {
namespace {

template <typename Row>
void print(std::string_view table) {
  std::cout << "<!-- columns: " << table << " -->\n| column | meaning |\n|---|---|\n";
  for (const Column<Row>& column : columns_of<Row>()) {
    const std::string_view quote = column.each == nullptr ? "`" : "";
    std::cout << "| " << quote << column.name << quote << " | " << column.meaning << " |\n";
  }
  std::cout << "<!-- end of columns -->\n";
}

}  // namespace
}  // namespace pirsim

int main() {
  pirsim::print<pirsim::Sample>("rows");
  pirsim::print<pirsim::OccupantLine>("occupants");
  pirsim::print<pirsim::ZoneLine>("zones");
  pirsim::print<pirsim::TraceLine>("trace");
  pirsim::print<pirsim::DayLine>("a dataset's rows");
}
