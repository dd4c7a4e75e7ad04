// Takes requests from the loopback address and hands back answers, whoever connects and however slowly:
//
// - One thread moves all bytes, none waits for a guest. Only whole requests reach the threads that answer.
// - A request may be 16 kB long and take 5 s, an answer 10 s. A connection serves one request.
// - At most 64 connections are open. A new one takes the place of the one that has been asking for longest: a page
//   sends its request as it connects, so those that keep their place by sending nothing lose it.
#pragma once

#include <functional>
#include <memory>
#include <string>

namespace cdem::app {

class Doorway {
public:
  // The bytes of an answer to the bytes of a request; called by several threads at a time.
  using Answer = std::function<std::string(const std::string& request)>;

  Doorway();  // script::FileError where no port can be had
  ~Doorway(); // answers that are on their way have half a second
  Doorway(const Doorway&) = delete;
  Doorway& operator=(const Doorway&) = delete;

  int port() const;
  void open(Answer); // once

private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace cdem::app
