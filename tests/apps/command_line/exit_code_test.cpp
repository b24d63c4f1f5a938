#include <gtest/gtest.h>
#include <signal.h>

#include <map>
#include <sstream>
#include <string>

#include "program.h"
#include "support/shapes.h"

namespace orchard {
namespace {

using test::Workplace;

// The rows "| 130 | .. |" of the page of all commands.
std::map<int, std::string> documented(const Workplace& here) {
  std::map<int, std::string> rows;
  std::istringstream page(here.run({"reference", "markdown"}).out);
  for (std::string line; std::getline(page, line);) {
    if (line.size() < 6 || !line.starts_with("| ") || std::isdigit(static_cast<unsigned char>(line[2])) == 0) continue;
    std::size_t digits = 0;
    const int code = std::stoi(line.substr(2), &digits);
    EXPECT_TRUE(rows.emplace(code, line.substr(2 + digits)).second) << code << " is there twice";
  }
  return rows;
}

TEST(ExitCodes, AreOneTableOnThePageAndInTheManual) {
  const Workplace here;
  const auto rows = documented(here);
  std::string codes;
  for (const auto& [code, meaning] : rows) codes += std::to_string(code) + ' ';
  EXPECT_EQ(codes, "0 1 2 3 4 5 130 ");
  const std::string manual = here.run({"reference", "man"}).out;
  const std::size_t status = manual.find(".SH EXIT STATUS"), end = manual.find(".SH", status + 1);
  ASSERT_NE(status, std::string::npos);
  for (const auto& [code, meaning] : rows) {
    const std::size_t row = manual.find(".B " + std::to_string(code) + "\n", status);
    EXPECT_LT(row, end) << code;
  }
}

TEST(ExitCodes, AreThoseOfTheTable) {
  const Workplace here;
  const std::string ball = here.add("ball.obj", test::icosphere(2)), other = here.add("l.obj", test::l_shape());
  const std::string out = (here / "out").string(), tree = out + "/ball.orchard";
  EXPECT_EQ(here.run(test::quick_build(ball, out)).exit_code, 0);
  EXPECT_EQ(here.run({"verify", tree, ball}).exit_code, 0);
  EXPECT_EQ(here.run({"verify", tree, other}).exit_code, 1) << "not proven";
  EXPECT_EQ(here.run({"inspect", ball}, "/dev/full").exit_code, 1) << "it could not be printed";
  EXPECT_EQ(here.run({"inspect", (here / "none.obj").string()}).exit_code, 2);
  EXPECT_EQ(here.run({"inspect", ball, "--nothing"}).exit_code, 2);
  test::Running program({"build", ball, "-o", out, "--depth", "6", "--effort", "high", "--quiet"}, {}, here / "err");
  ASSERT_TRUE(program.listens());
  program.send(SIGINT);
  EXPECT_EQ(program.wait(), 130);
}

}  // namespace
}  // namespace orchard
