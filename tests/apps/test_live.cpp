// `cdem run --live`: what the page is given, who is refused, and that a browser shows it.
#include "tests/apps/support/child.hpp"

#include <catch2/catch.hpp>

#include <arpa/inet.h>
#include <chrono>
#include <cstdlib>
#include <future>
#include <netinet/in.h>
#include <regex>
#include <sys/socket.h>
#include <thread>
#include <unistd.h>

using namespace testing;
using Catch::Matchers::Contains;

namespace {

// A relaxation that never gets where it is to go.
const std::string endless =
    "local cdem = require 'cdem'\n"
    "local rock = cdem.elastic{ youngs_modulus = 30e9, poissons_ratio = 0.2, density = 2500 }\n"
    "local block = cdem.grid{ size = {1, 1, 1}, divisions = {2, 2, 2} }\n"
    "local model = cdem.model{ bodies = { { shape = block, material = rock,\n"
    "  joint = cdem.mohr_coulomb{ cohesion = 1e9, friction_angle = 30, tensile_strength = 1e9 },\n"
    "  element = 'small_strain' } } }\n"
    "model:fix{ on = 'z-', axes = 'xyz' }\n"
    "model:traction{ on = 'z+', stress = {0, 0, -1e6} }\n"
    "model:run{ duration = 1e6 }\n";

class LiveRun {
public:
  LiveRun() {
    write_file(folder_ / "case.lua", endless);
    ended_ = std::async(std::launch::async, [this] {
      Start start;
      start.folder = folder_.path();
      start.limit = 120;
      return run_program({"/bin/sh", "-c",
                          "exec '" CDEM_PROGRAM "' run case.lua --live --threads 1 --output out >said 2>&1"},
                         start);
    });
    const std::regex address("http://127\\.0\\.0\\.1:([0-9]+)/([0-9a-f]+)/");
    for (int i = 0; i < 600 && port == 0; ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
      std::smatch found;
      if (const std::string said = read_file(folder_ / "said"); std::regex_search(said, found, address)) {
        url = found[0];
        port = std::stoi(found[1]);
        token = found[2];
      }
    }
    REQUIRE(port > 0);
  }
  ~LiveRun() {
    if (ended_.valid())
      stop();
  }

  // Sends the bytes as they are; the answer.
  std::string raw(const std::string& request) const {
    const int file = socket(AF_INET, SOCK_STREAM, 0);
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_port = htons(static_cast<std::uint16_t>(port));
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    std::string answer;
    if (connect(file, reinterpret_cast<const sockaddr*>(&to), sizeof to) == 0 &&
        send(file, request.data(), request.size(), MSG_NOSIGNAL) >= 0) {
      char bytes[4096];
      for (ssize_t n = 0; (n = recv(file, bytes, sizeof bytes, 0)) > 0;)
        answer.append(bytes, static_cast<std::size_t>(n));
    }
    close(file);
    return answer;
  }
  std::string ask(const std::string& what, const std::string& host = "", const std::string& more = "",
                  const std::string& method = "GET", const std::string& body = "") const {
    return raw(method + " " + what + " HTTP/1.1\r\nHost: " +
               (host.empty() ? "127.0.0.1:" + std::to_string(port) : host) + "\r\nConnection: close\r\n" +
               more + (body.empty() ? "" : "Content-Type: application/x-www-form-urlencoded\r\n") +
               "Content-Length: " + std::to_string(body.size()) + "\r\n\r\n" + body);
  }
  std::string here(const std::string& name) const { return "/" + token + "/" + name; }
  Outcome stop() {
    ask(here("stop"), "", "", "POST");
    return ended_.get();
  }
  Outcome end() { return ended_.get(); }
  std::string said() const { return read_file(folder_ / "said"); }
  std::string log() const { return read_file(folder_ / "out/cdem.log"); }

  int port = 0;
  std::string token, url;

private:
  TempFolder folder_;
  std::future<Outcome> ended_;
};

std::string first_line(const std::string& answer) {
  return answer.substr(0, answer.find("\r\n"));
}

// Asks until the answer holds the text, at most 20 s.
std::string until(const LiveRun& run, const std::string& what, const std::string& text) {
  std::string answer;
  for (int i = 0; i < 200; ++i) {
    answer = run.ask(run.here(what));
    if (answer.find(text) != std::string::npos)
      break;
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  return answer;
}

} // namespace

TEST_CASE("a live run gives its page, its state and frames, and stops when asked to") {
  LiveRun run;
  CHECK_THAT(run.ask(run.here("")), Contains("200 OK") && Contains("<!DOCTYPE html>") &&
                                        Contains("default-src 'none'") && Contains("nosniff"));
  CHECK_THAT(run.ask(run.here("page.js")), Contains("text/javascript"));
  CHECK_THAT(until(run, "status", "\"frame\":1"), Contains("\"case\":\"out\"") && Contains("displacement.x"));
  CHECK_THAT(run.ask(run.here("frame.png")), Contains("image/png") && Contains("\x89PNG"));
  CHECK_THAT(run.ask(run.here("show"), "", "", "POST", "colour=stress.zz&view=top&deformation=100"),
             Contains("204"));
  CHECK_THAT(until(run, "status", "\"view\":\"top\""), Contains("\"colour\":\"stress.zz\""));
  const Outcome outcome = run.stop();
  CHECK(outcome.exit_code == 130);
  CHECK_THAT(run.said(), Contains("cdem: error: stopped"));
  CHECK_THAT(run.log(),
             Contains("ended with exit code 130") && !Contains(run.token)); // others may read the log
}

TEST_CASE("a live run refuses strangers, other hosts, other origins and nonsense") {
  LiveRun run;
  CHECK(run.token.size() == 32);
  const std::string port = ":" + std::to_string(run.port);
  // Without the token there is nothing.
  for (const std::string& path :
       {std::string("/"), std::string("/status"), "/" + std::string(32, '0') + "/status",
        "/" + run.token.substr(1) + "/", "/" + run.token, "//" + run.token + "/status",
        std::string("/../../etc/passwd")}) {
    INFO(path);
    const std::string answer = run.ask(path);
    CHECK_THAT(first_line(answer), Contains("404"));
    CHECK_THAT(answer, !Contains("case"));
  }
  CHECK_THAT(first_line(run.ask(run.here("../../../../etc/passwd"))), Contains("404"));
  // A name that somebody made to point here is another host.
  for (const std::string& host :
       {"evil.example" + port, std::string("evil.example"), std::string("127.0.0.1"),
        "127.0.0.1" + port + "0", "127.0.0.1.evil.example" + port, std::string(" ")})
    CHECK_THAT(first_line(run.ask(run.here("status"), host)), Contains("403"));
  CHECK_THAT(first_line(run.ask(run.here("status"), "localhost" + port)), Contains("200"));
  CHECK_THAT(first_line(run.ask(run.here("status"), "", "Host: evil.example\r\n")), Contains("403"));
  CHECK_THAT(first_line(run.raw("GET " + run.here("status") + " HTTP/1.0\r\n\r\n")), Contains("403"));
  // A page of another site can neither stop the run nor steer it.
  for (const char* origin : {"http://evil.example", "null", "https://127.0.0.1"})
    CHECK_THAT(first_line(run.ask(run.here("stop"), "", "Origin: " + std::string(origin) + "\r\n", "POST")),
               Contains("403"));
  CHECK_THAT(first_line(run.ask(run.here("stop"))), Contains("404")); // GET stops nothing
  // Wishes that mean nothing, and bytes that are no request.
  until(run, "status", "\"frame\":1");
  for (const std::string& wish :
       {std::string("colour=nonsense"), std::string("view=%3Cscript%3E"), std::string("up=x"),
        std::string("deformation=nan"), std::string("deformation=1e99"), std::string("file=/etc/passwd"),
        "colour=" + std::string(1000, 'a')})
    CHECK_THAT(first_line(run.ask(run.here("show"), "", "", "POST", wish)), Contains("400"));
  CHECK_THAT(first_line(run.ask(run.here("show"), "", "", "POST", "colour=" + std::string(100000, 'a'))),
             !Contains("204"));
  for (const std::string& bytes : {std::string("\0\0\0\r\n\r\n", 7), std::string("GET\r\n\r\n"),
                                   "GET /" + std::string(100000, 'a') + " HTTP/1.1\r\n\r\n",
                                   std::string("POST / HTTP/1.1\r\nContent-Length: -5\r\n\r\n")})
    CHECK_THAT(first_line(run.raw(bytes)), !Contains("200"));
  // It still answers, and it listens on the loopback address alone.
  CHECK_THAT(first_line(run.ask(run.here("status"))), Contains("200"));
  char hex[16];
  std::snprintf(hex, sizeof hex, ":%04X", static_cast<unsigned>(run.port));
  int sockets = 0;
  for (const char* table : {"/proc/net/tcp", "/proc/net/tcp6"})
    for (const std::string& line : lines_of(read_file(table)))
      if (const auto local = line.substr(0, line.find(" 0", 8)); line.find(hex) < 20) {
        ++sockets;
        CHECK_THAT(line, Contains("0100007F" + std::string(hex)));
      }
  CHECK(sockets > 0);
  CHECK(run.stop().exit_code == 130);
}

TEST_CASE("a browser shows a live run and stops it") {
  if (std::system("command -v chromium python3 >/dev/null 2>&1 && test -x \"$(command -v chromium)\"") != 0) {
    WARN("chromium or python3 is missing: the page is not tried in a browser");
    return;
  }
  LiveRun run;
  Start start;
  start.limit = 100;
  const Outcome browser =
      run_program({"/usr/bin/env", "python3", CDEM_SOURCE "/tests/apps/live_browser.py", run.url}, start);
  INFO(browser.out << browser.err);
  CHECK(browser.exit_code == 0);
  CHECK(run.end().exit_code == 130); // by the button
}
