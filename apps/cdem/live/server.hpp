// Serves the page of `cdem run --live` and `cdem view` to browsers of this machine. What keeps others out:
//
// - It listens on the loopback address alone, on a port that the system chooses.
// - Every address begins with 128 random bits; without them nothing is answered. Other users of the machine do not know
//   them.
// - The Host of a request must be the loopback address with the port: a page of another site whose name was made to point
//   here (DNS rebinding) is refused. So is a POST from another origin.
// - Requests are bounded in bytes and time, and connections in number (doorway.hpp). Nothing is read from or written to
//   files.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>

namespace cdem::app {

// Called by threads of the server, several at a time.
struct Answers {
  std::function<std::string(int seen)> status; // JSON; may wait while frame number `seen` is the newest
  std::function<std::string()> frame;          // PNG; empty: none yet
  // Wishes for the next frames (FrameWish). False: one that cannot be met.
  std::function<bool(const std::map<std::string, std::string>&)> show;
  std::function<void()> stop;
};

class LiveServer {
public:
  explicit LiveServer(Answers); // script::FileError where no port can be had
  ~LiveServer();
  LiveServer(const LiveServer&) = delete;
  LiveServer& operator=(const LiveServer&) = delete;

  const std::string& url() const; // "http://127.0.0.1:41234/5f..e0/"

private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace cdem::app
