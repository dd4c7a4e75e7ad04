// Work in a child process: results come back whole; what crashes or runs out of bounds there is one line here.
#include "libgeom/child/bytes.hpp"
#include "libgeom/child/process.hpp"
#include "libgeom/core/error.hpp"
#include "libgeom/core/stop.hpp"
#include "tests/support/refusal.hpp"

#include <catch2/catch.hpp>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <thread>

using namespace geom;
using Catch::Matchers::Contains;
using testing::refusal;

namespace {

std::string refused(const std::function<std::string()>& work, const ChildLimits& limits = {}) {
  return refusal([&] { run_in_child("reading a.step", limits, work); });
}

template <class T>
T through_bytes(const T& x) {
  std::string bytes;
  pack(bytes, x);
  Unpacker in(bytes);
  T back{};
  unpack(in, back);
  in.end();
  return back;
}

} // namespace

TEST_CASE("a child hands back what it was asked for, however much") {
  CHECK(run_in_child("work", {}, [] { return std::string("result"); }) == "result");
  CHECK(run_in_child("work", {}, [] { return std::string(); }).empty());
  const std::string large(20'000'000, 'x');
  CHECK(run_in_child("work", {}, [&] { return large; }) == large);
}

TEST_CASE("a child changes nothing of the process that started it") {
  int count = 0;
  run_in_child("work", {}, [&] {
    ++count;
    setenv("CDEM_TEST_CHILD", "1", 1);
    return std::string();
  });
  CHECK(count == 0);
  CHECK(std::getenv("CDEM_TEST_CHILD") == nullptr);
}

TEST_CASE("exceptions of a child arrive with their kind and text") {
  CHECK(refused([]() -> std::string { throw InputError("size = 0: must be more"); }) ==
        "size = 0: must be more");
  CHECK_THROWS_WITH(run_in_child("work", {}, []() -> std::string { throw std::runtime_error("no disk"); }),
                    "no disk");
  CHECK_THROWS_AS(run_in_child("work", {}, []() -> std::string { throw std::bad_alloc(); }), std::bad_alloc);
  CHECK_THAT(refused([]() -> std::string { throw 1; }), Contains("reading a.step"));
}

TEST_CASE("a crash, an abort and an exit of a child are one line that names the work") {
  ChildLimits limits;
  limits.blame = "the file is damaged";
  for (const int number : {SIGSEGV, SIGABRT, SIGBUS, SIGFPE, SIGILL}) {
    const std::string said = refused(
        [&] {
          std::raise(number);
          return std::string();
        },
        limits);
    CHECK_THAT(said, Contains("reading a.step: the file is damaged: the geometry kernel crashed"));
    CHECK(said.find('\n') == std::string::npos);
  }
  CHECK_THAT(refused([]() -> std::string { std::abort(); }), Contains("crashed"));
  CHECK_THAT(refused([]() -> std::string { std::_Exit(0); }), Contains("crashed"));
}

TEST_CASE("limits of memory and of processor time end a child") {
  ChildLimits limits;
  limits.memory = std::uint64_t{1} << 28;
  CHECK_THAT(refused([] { return std::string(std::size_t{1} << 32, 'x'); }, limits),
             Contains("of memory") || Contains("crashed")); // the second under the address sanitizer
  limits = {};
  limits.seconds = 1;
  CHECK_THAT(refused(
                 []() -> std::string {
                   for (volatile int i = 0;;)
                     i = i + 1;
                 },
                 limits),
             Contains("more than the 1 s of processor time"));
}

TEST_CASE("a child is ended when the user asks to stop") {
  const auto begin = std::chrono::steady_clock::now();
  const auto passed = [&] { return std::chrono::steady_clock::now() - begin; };
  struct NoCheck {
    ~NoCheck() { set_stop_check({}); }
  } no_check;
  set_stop_check([&] { return passed() > std::chrono::milliseconds(200); });
  CHECK_THROWS_AS(run_in_child("work", {},
                               [] {
                                 std::this_thread::sleep_for(std::chrono::seconds(60));
                                 return std::string();
                               }),
                  Stopped);
  CHECK(passed() < std::chrono::seconds(10));
}

TEST_CASE("values pass through bytes, and bytes that are cut or forged are refused") {
  const std::vector<std::vector<int>> lists = {{1, 2, 3}, {}, {4}};
  CHECK(through_bytes(lists) == lists);
  const std::vector<Vec3> places = {{1, 2, 3}, {4, 5, 6}};
  CHECK(through_bytes(places) == places);
  CHECK(through_bytes(std::string("text")) == "text");
  std::string bytes;
  pack(bytes, places);
  const auto refuses = [](const std::string& forged) {
    Unpacker in(forged);
    std::vector<Vec3> out;
    CHECK_THROWS_AS((unpack(in, out), in.end()), std::runtime_error);
  };
  for (std::size_t length = 0; length < bytes.size(); ++length)
    refuses(bytes.substr(0, length));
  refuses(bytes + "x");
  for (const std::uint64_t count :
       {std::uint64_t{1}, std::uint64_t{3}, ~std::uint64_t{0}, std::uint64_t{1} << 61}) {
    std::string forged = bytes;
    std::memcpy(forged.data(), &count, sizeof count);
    refuses(forged);
  }
}
