#include "tests/apps/support/served_page.hpp"

#include <catch2/catch.hpp>

#include <arpa/inet.h>
#include <chrono>
#include <netinet/in.h>
#include <regex>
#include <sys/socket.h>
#include <thread>
#include <unistd.h>

namespace testing {

ServedPage::ServedPage(const std::vector<File>& files, const std::string& arguments,
                       const std::string& before) {
  for (const File& file : files)
    write_file(folder_ / file.name, file.text);
  Start start;
  start.folder = folder_.path();
  start.limit = 120;
  const auto shell = [start](const std::string& words) {
    return run_program({"/bin/sh", "-c", "exec '" CDEM_PROGRAM "' " + words + " >said 2>&1"}, start);
  };
  if (!before.empty())
    REQUIRE(shell(before).exit_code == 0);
  std::filesystem::remove(folder_ / "said");
  ended_ = std::async(std::launch::async, [shell, arguments] { return shell(arguments); });
  const std::regex address("http://127\\.0\\.0\\.1:([0-9]+)/([0-9a-f]+)/");
  for (int i = 0; i < 600 && port == 0; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    std::smatch found;
    if (const std::string text = said(); std::regex_search(text, found, address)) {
      url = found[0];
      port = std::stoi(found[1]);
      token = found[2];
    }
  }
  REQUIRE(port > 0);
}

ServedPage::~ServedPage() {
  if (ended_.valid())
    stop();
}

std::string ServedPage::raw(const std::string& request) const {
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

std::string ServedPage::ask(const std::string& what, const std::string& host, const std::string& more,
                            const std::string& method, const std::string& body) const {
  return raw(method + " " + what + " HTTP/1.1\r\nHost: " +
             (host.empty() ? "127.0.0.1:" + std::to_string(port) : host) + "\r\nConnection: close\r\n" +
             more + (body.empty() ? "" : "Content-Type: application/x-www-form-urlencoded\r\n") +
             "Content-Length: " + std::to_string(body.size()) + "\r\n\r\n" + body);
}

Outcome ServedPage::stop() {
  ask(here("stop"), "", "", "POST");
  return ended_.get();
}

Outcome ServedPage::end() {
  return ended_.get();
}

std::string ServedPage::said() const {
  return read_file(folder_ / "said");
}

std::string first_line(const std::string& answer) {
  return answer.substr(0, answer.find("\r\n"));
}

std::string until(const ServedPage& page, const std::string& what, const std::string& text) {
  std::string answer;
  for (int i = 0; i < 200; ++i) {
    answer = page.ask(page.here(what));
    if (answer.find(text) != std::string::npos)
      break;
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  return answer;
}

} // namespace testing
