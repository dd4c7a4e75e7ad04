#include "apps/cdem/live/server.hpp"

#include "apps/cdem/live/doorway.hpp"
#include "apps/cdem/live/page.hpp"
#include "lua/binding/runtime/engine.hpp"

#include <httplib.h>

#include <algorithm>
#include <cstring>
#include <sys/random.h>

namespace cdem::app {
namespace {

constexpr const char* loopback = "127.0.0.1";
constexpr std::size_t longest_body = 4096; // bytes

std::string random_token() {
  unsigned char bytes[16];
  if (getrandom(bytes, sizeof bytes, 0) != static_cast<ssize_t>(sizeof bytes))
    throw script::FileError("the page: the system gives no random numbers");
  std::string text;
  for (const unsigned char byte : bytes) {
    char two[3];
    std::snprintf(two, sizeof two, "%02x", byte);
    text += two;
  }
  return text;
}

// In a time that does not tell how much of it was right.
bool same(const std::string& a, const std::string& b) {
  if (a.size() != b.size())
    return false;
  unsigned difference = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    difference |= static_cast<unsigned>(static_cast<unsigned char>(a[i]) ^ static_cast<unsigned char>(b[i]));
  return difference == 0;
}

// A request and its answer in memory: the doorway has received the one and sends the other.
class InMemory final : public httplib::Stream {
public:
  explicit InMemory(const std::string& request) : request_(request) {}
  std::string answer;

  bool is_readable() const override { return read_ < request_.size(); }
  bool is_writable() const override { return true; }
  ssize_t read(char* to, std::size_t size) override {
    const std::size_t count = std::min(size, request_.size() - read_);
    std::memcpy(to, request_.data() + read_, count);
    read_ += count;
    return static_cast<ssize_t>(count);
  }
  ssize_t write(const char* from, std::size_t size) override {
    answer.append(from, size);
    return static_cast<ssize_t>(size);
  }
  void get_remote_ip_and_port(std::string&, int&) const override {}
  void get_local_ip_and_port(std::string&, int&) const override {}
  socket_t socket() const override { return -1; }

private:
  const std::string& request_;
  std::size_t read_ = 0;
};

// The library's reading of requests and its routes, without its sockets.
class Routes final : public httplib::Server {
public:
  std::string answer(const std::string& request) {
    InMemory both(request);
    bool closed = false;
    process_request(both, true, closed, nullptr);
    return both.answer;
  }
};

} // namespace

struct LiveServer::Impl {
  Answers answers;
  std::string token = random_token(), url;
  int port = 0;
  Routes server;
  Doorway doorway; // the last: its threads use the rest

  bool is_own_host(const std::string& host) const {
    const std::string number = ":" + std::to_string(port);
    return host == loopback + number || host == "localhost" + number;
  }

  // What is refused before anything else looks at it: 403 for a stranger, 404 where the token is missing.
  int refusal(const httplib::Request& request) const {
    if (request.get_header_value_count("Host") != 1 || !is_own_host(request.get_header_value("Host")))
      return 403;
    if (request.has_header("Origin")) {
      const std::string origin = request.get_header_value("Origin");
      if (origin.rfind("http://", 0) != 0 || !is_own_host(origin.substr(7)))
        return 403;
    }
    if (request.path.size() < token.size() + 2 || !same(request.path.substr(1, token.size()), token) ||
        request.path[token.size() + 1] != '/')
      return 404;
    return 0;
  }

  void set_routes() {
    using httplib::Request;
    using httplib::Response;
    const std::string here = "/" + token + "/";
    const auto text = [&](const char* name, const char* content, const char* type) {
      server.Get(here + name, [content, type](const Request&, Response& r) { r.set_content(content, type); });
    };
    text("", page_html, "text/html; charset=utf-8");
    text("page.css", page_css, "text/css; charset=utf-8");
    text("page.js", page_js, "text/javascript; charset=utf-8");
    server.Get(here + "status", [this](const Request& request, Response& r) {
      const int seen = request.has_param("seen") ? std::atoi(request.get_param_value("seen").c_str()) : -1;
      r.set_content(answers.status(seen), "application/json");
    });
    server.Get(here + "frame\\.png", [this](const Request&, Response& r) {
      const std::string png = answers.frame();
      if (png.empty())
        r.status = 404;
      else
        r.set_content(png, "image/png");
    });
    server.Post(here + "show", [this](const Request& request, Response& r) {
      std::map<std::string, std::string> wishes;
      for (const auto& [name, value] : request.params)
        wishes[name] = value;
      r.status = answers.show(wishes) ? 204 : 400;
    });
    server.Post(here + "stop", [this](const Request&, Response& r) {
      answers.stop();
      r.status = 204;
    });
  }
};

LiveServer::LiveServer(Answers answers) : impl_(std::make_unique<Impl>()) {
  Impl& all = *impl_;
  all.answers = std::move(answers);
  httplib::Server& server = all.server;
  server.set_payload_max_length(longest_body);
  server.set_default_headers(
      {{"Cache-Control", "no-store"},
       {"Content-Security-Policy", "default-src 'none'; script-src 'self'; style-src 'self' 'unsafe-inline'; "
                                   "img-src 'self' data:; connect-src 'self'; "
                                   "frame-ancestors 'none'; base-uri 'none'; form-action 'none'"},
       {"Cross-Origin-Resource-Policy", "same-origin"},
       {"Referrer-Policy", "no-referrer"},
       {"X-Content-Type-Options", "nosniff"},
       {"X-Frame-Options", "DENY"}});
  server.set_pre_routing_handler([&all](const httplib::Request& request, httplib::Response& response) {
    response.status = all.refusal(request);
    if (response.status == 0) {
      response.status = -1; // as it was: the routes decide
      return httplib::Server::HandlerResponse::Unhandled;
    }
    return httplib::Server::HandlerResponse::Handled;
  });
  server.set_exception_handler([](const httplib::Request&, httplib::Response& response, std::exception_ptr) {
    response.status = 500;
  });
  all.set_routes();
  all.port = all.doorway.port();
  all.url = "http://" + std::string(loopback) + ":" + std::to_string(all.port) + "/" + all.token + "/";
  all.doorway.open([&all](const std::string& request) { return all.server.answer(request); });
}

LiveServer::~LiveServer() = default;

const std::string& LiveServer::url() const {
  return impl_->url;
}

} // namespace cdem::app
