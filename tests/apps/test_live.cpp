// `cdem run --live` and `cdem view`: what the page is given, who is refused, and that a browser shows it.
#include "tests/apps/support/served_page.hpp"
#include "tests/vtk/image.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <memory>
#include <thread>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

using namespace testing;
using Catch::Matchers::Contains;

namespace {

const char* const column =
    "local cdem = require 'cdem'\n"
    "local rock = cdem.elastic{ youngs_modulus = 30e9, poissons_ratio = 0.2, density = 2500 }\n"
    "local block = cdem.grid{ size = {1, 1, 1}, divisions = {2, 2, 2} }\n"
    "local model = cdem.model{ bodies = { { shape = block, material = rock,\n"
    "  joint = cdem.mohr_coulomb{ cohesion = 1e9, friction_angle = 30, tensile_strength = 1e9 },\n"
    "  element = 'small_strain' } } }\n"
    "model:fix{ on = 'z-', axes = 'xyz' }\n";

// A run that never gets where it is to go.
const std::string endless = std::string(column) + "model:traction{ on = 'z+', stress = {0, 0, -1e6} }\n"
                                                  "model:run{ duration = 1e6 }\n";

class LiveRun : public ServedPage {
public:
  explicit LiveRun(const std::string& options = "")
      : ServedPage({{"case.lua", endless}}, "run case.lua --live --threads 1 --output out " + options) {}
  std::string log() const { return read_file(folder() / "out/cdem.log"); }
};

// In headless chromium, by a script beside this file. False, with a warning, where there is none.
bool browser_can(const std::string& script, const ServedPage& page) {
  if (std::system("command -v chromium python3 >/dev/null 2>&1 && test -x \"$(command -v chromium)\"") != 0) {
    WARN("chromium or python3 is missing: the page is not tried in a browser");
    return false;
  }
  Start start;
  start.limit = 100;
  const Outcome browser =
      run_program({"/usr/bin/env", "python3", CDEM_SOURCE "/tests/apps/" + script, page.url}, start);
  INFO(browser.out << browser.err);
  CHECK(browser.exit_code == 0);
  return true;
}

// A column that is pressed: three states of a series, and the last one by itself.
const std::string pressed = std::string(column) +
                            "model:traction{ on = 'z+', stress = {0, 0, -1e6} }\n"
                            "for step = 1, 3 do\n"
                            "  model:run{ duration = 1e-4 }\n"
                            "  model:save{ file = 'run' .. step .. '.vtu', series = 'run.pvd' }\n"
                            "end\n"
                            "model:save{ file = 'end.vtkhdf' }\n";

class Viewed : public ServedPage {
public:
  Viewed() : ServedPage({{"case.lua", pressed}}, "view out", "run case.lua --threads 1 --output out") {}
};

// Two blocks with a gap of 2 m between them, loaded as `load` says, in a run that goes on and on.
std::string blocks_with(const std::string& load) {
  return "local cdem = require 'cdem'\n"
         "local rock = cdem.elastic{ youngs_modulus = 30e9, poissons_ratio = 0.2, density = 2500 }\n"
         "local function block(x)\n"
         "  return { shape = cdem.box_mesh{ size = {1, 1, 1}, divisions = {1, 1, 1}, origin = {x, 0, 0} },\n"
         "           material = rock }\n"
         "end\n"
         "local model = cdem.model{ bodies = { block(0), block(3) } }\n"
         "model:fix{ on = 'z-' }\n" +
         load + "\nmodel:run{ duration = 1e6 }\n";
}

// Pale blue pixels of a frame of the page: colours of a body are darker.
int water_shown(const std::string& script) {
  const ServedPage run({{"case.lua", script}}, "run case.lua --live --threads 1 --output out");
  until(run, "status", "\"frame\":1");
  const std::string answer = run.ask(run.here("frame.png"));
  const std::string file = run.folder() / "frame.png";
  write_file(file, answer.substr(answer.find("\r\n\r\n") + 4));
  const Image frame = read_png(file);
  int blue = 0;
  for (int y = 0; y < frame.height; ++y)
    for (int x = 0; x < frame.width; ++x) {
      const std::array<int, 3> colour = frame.at(x, y);
      blue += colour[0] > 150 && colour[2] > colour[0] + 30;
    }
  return blue;
}

} // namespace

TEST_CASE("a live run shows the free surface of the water that loads it") {
  CHECK(water_shown(blocks_with(
            "model:flow{ water = cdem.water.uniform{ velocity = {0.5, 0, 0}, level = 0.5 } }")) > 10000);
  CHECK(water_shown(blocks_with("")) == 0);
}

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

TEST_CASE("a live run of two ranks gives its page frames, and stops when asked to") {
  if (no_mpirun())
    return;
  LiveRun run("--ranks 2");
  CHECK_THAT(until(run, "status", "\"frame\":2"), Contains("\"frame\":2"));
  CHECK(run.stop().exit_code == 130);
  CHECK_THAT(run.log(), Contains("2 ranks of 1 thread") && Contains("ended with exit code 130"));
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
  LiveRun run;
  if (browser_can("live_browser.py", run))
    CHECK(run.end().exit_code == 130); // by the button
}

TEST_CASE("the page of saved files offers each file once, and draws what is asked for") {
  Viewed page;
  const std::string first = until(page, "status", "\"frame\":1");
  CHECK_THAT(first, Contains("{\"name\":\"run.pvd\",\"steps\":3},{\"name\":\"end.vtkhdf\",\"steps\":1}") &&
                        !Contains("_bonds") && Contains("run1.vtu: time 0.0001"));
  CHECK_THAT(page.ask(page.here("frame.png")), Contains("\x89PNG"));
  const auto show = [&](const std::string& words) {
    return first_line(page.ask(page.here("show"), "", "", "POST", words));
  };
  CHECK_THAT(show("step=2&turn=30&zoom=2&low=-1&high=1"), Contains("204"));
  CHECK_THAT(until(page, "status", "\"step\":2"),
             Contains("\"turn\":30.0") && Contains("\"range\":[-1.0,1.0]") && Contains("run3.vtu"));
  CHECK_THAT(show("file=1"), Contains("204")); // its first step
  CHECK_THAT(until(page, "status", "\"file\":1"), Contains("\"step\":0") && Contains("end.vtkhdf: time"));
  for (const char* wish :
       {"file=2", "file=-1", "file=../out/end.vtkhdf", "step=1", "file=0&step=3", "step=0.5", "turn=x",
        "zoom=0", "zoom=1e9", "low=1&high=0", "low=1", "right=nan"}) {
    INFO(wish);
    CHECK_THAT(show(wish), Contains("400"));
  }
  CHECK_THAT(first_line(page.ask("/" + std::string(32, '0') + "/status")), Contains("404"));
  CHECK_THAT(first_line(page.ask(page.here("status"), "evil.example:" + std::to_string(page.port))),
             Contains("403"));
  CHECK(page.stop().exit_code == 0);
}

TEST_CASE("a file that is damaged while it is viewed is told of, and the page goes back") {
  Viewed page;
  until(page, "status", "\"frame\":1");
  write_file(page.folder() / "out/run2.vtu", "nonsense");
  CHECK_THAT(page.ask(page.here("show"), "", "", "POST", "step=1"), Contains("204"));
  CHECK_THAT(until(page, "status", "incomplete"), Contains("\"step\":0"));
  CHECK_THAT(page.ask(page.here("show"), "", "", "POST", "step=2"), Contains("204"));
  CHECK_THAT(until(page, "status", "\"step\":2"), Contains("run3.vtu: time"));
  CHECK(page.stop().exit_code == 0);
}

TEST_CASE("a browser shows saved files, turns them and plays a series") {
  Viewed page;
  if (browser_can("view_browser.py", page))
    CHECK(page.end().exit_code == 0); // by the button
}

TEST_CASE("what cannot be viewed is one line") {
  TempFolder folder;
  Start start;
  start.folder = folder.path();
  const std::string head = "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\"><Collection>",
                    tail = "</Collection></VTKFile>\n";
  write_file(folder / "up.pvd", head + "<DataSet timestep=\"0\" file=\"../../etc/passwd\"/>" + tail);
  write_file(folder / "root.pvd", head + "<DataSet timestep=\"0\" file=\"/etc/passwd\"/>" + tail);
  write_file(folder / "none.pvd", head + tail);
  write_file(folder / "junk.pvd", std::string("junk\0junk", 9));
  write_file(folder / "lost.pvd", head + "<DataSet timestep=\"0\" file=\"lost.vtu\"/>" + tail);
  write_file(folder / "text.txt", "text");
  std::filesystem::create_directory(folder / "empty");
  const auto said = [&](const std::string& path, int exit_code) {
    const Outcome outcome = run_cdem({"view", path}, start);
    CHECK(outcome.exit_code == exit_code);
    CHECK(lines_of(outcome.err).size() == 1);
    CHECK(outcome.out.empty());
    return outcome.err;
  };
  CHECK_THAT(said("up.pvd", 2), Contains("outside its folder"));
  CHECK_THAT(said("root.pvd", 2), Contains("outside its folder"));
  CHECK_THAT(said("none.pvd", 2), Contains("lists no file"));
  CHECK_THAT(said("junk.pvd", 2), Contains("it is none, or it is damaged"));
  CHECK_THAT(said("lost.pvd", 4), Contains("lost.vtu") && Contains("no such file"));
  CHECK_THAT(said("text.txt", 2), Contains("must be a .vtu, .pvtu or .vtkhdf file"));
  CHECK_THAT(said("empty", 2), Contains("nothing to look at"));
  CHECK_THAT(said("nothing.vtu", 4), Contains("no such file"));
}

TEST_CASE("a .vtkhdf is drawn and described as the .vtu of the same state") {
  TempFolder folder;
  write_file(folder / "case.lua", pressed);
  Start start;
  start.folder = folder.path();
  REQUIRE(run_cdem({"run", "case.lua", "--threads", "1", "--output", "out"}, start).exit_code == 0);
  std::string pictures[2], described[2];
  const char* const names[] = {"out/run3.vtu", "out/end.vtkhdf"};
  for (int i = 0; i < 2; ++i) {
    REQUIRE(run_cdem({"render", names[i], "--colour", "stress.zz", "--output", "a.png"}, start).exit_code ==
            0);
    pictures[i] = read_file(folder / "a.png");
    const Outcome told = run_cdem({"info", names[i]}, start);
    CHECK(told.exit_code == 0);
    std::vector<std::string> lines = lines_of(told.out);
    std::sort(lines.begin(), lines.end()); // VTK's reader lists fields by name
    for (const std::string& line : lines)
      described[i] += line + "\n";
  }
  CHECK(pictures[0].size() > 1000);
  CHECK(pictures[0] == pictures[1]);
  CHECK_THAT(described[0], Contains("stress.zz"));
  CHECK(described[0] == described[1]);
}

namespace {

// A connection that asks slowly or without end.
class Attacker {
public:
  explicit Attacker(int port) : socket_(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_port = htons(static_cast<std::uint16_t>(port));
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    connected_ = connect(socket_, reinterpret_cast<const sockaddr*>(&to), sizeof to) == 0;
  }
  ~Attacker() { close(socket_); }
  Attacker(const Attacker&) = delete;
  Attacker& operator=(const Attacker&) = delete;
  bool say(const std::string& bytes) const { // false: it was sent away
    return connected_ && send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL | MSG_DONTWAIT) ==
                             static_cast<ssize_t>(bytes.size());
  }

private:
  int socket_;
  bool connected_ = false;
};

} // namespace

TEST_CASE("neither slow nor endless requests take memory, the page or the end of a run") {
  LiveRun run;
  std::vector<std::unique_ptr<Attacker>> slow;
  for (int i = 0; i < 300; ++i) {
    slow.push_back(std::make_unique<Attacker>(run.port));
    slow.back()->say("GET / HTTP/1.1\r\nX: ");
  }
  // A head without end is cut off after some kB.
  const Attacker endless_head(run.port);
  endless_head.say("GET / HTTP/1.1\r\n");
  std::string lines;
  for (int i = 0; i < 200; ++i)
    lines += "X" + std::to_string(i) + ": a\r\n";
  bool sent_away = false;
  for (int i = 0; i < 2000 && !sent_away; ++i) {
    sent_away = !endless_head.say(lines);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  CHECK(sent_away);
  // The owner's page is answered at once among 300 that ask for ever.
  const auto start = std::chrono::steady_clock::now();
  CHECK_THAT(run.ask(run.here("")), Contains("200 OK"));
  CHECK_THAT(run.ask(run.here("page.css")), Contains("200 OK"));
  CHECK(std::chrono::steady_clock::now() - start < std::chrono::seconds(2));
  const auto asked_to_stop = std::chrono::steady_clock::now();
  for (const auto& attacker : slow)
    attacker->say("a");
  CHECK(run.stop().exit_code == 130);
  CHECK(std::chrono::steady_clock::now() - asked_to_stop < std::chrono::seconds(5));
}
