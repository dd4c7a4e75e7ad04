#include "apps/cdem/live/doorway.hpp"

#include "lua/binding/runtime/engine.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <cstdlib>
#include <deque>
#include <list>
#include <mutex>
#include <thread>
#include <vector>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

namespace cdem::app {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

constexpr std::size_t most_guests = 64, longest_request = 16384; // bytes
constexpr std::size_t answering_threads = 8; // a browser asks for up to six things at a time
constexpr milliseconds time_to_ask{5000}, time_to_take{10000}, time_to_leave{500};

// Whether head and body of the request are there. A length that is none counts as 0: the answer refuses it.
bool is_whole(const std::string& request) {
  const auto end = request.find("\r\n\r\n");
  if (end == std::string::npos)
    return false;
  std::string head = request.substr(0, end + 2);
  std::transform(head.begin(), head.end(), head.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  const std::string field = "\r\ncontent-length:";
  const auto at = head.find(field);
  const long long length = at == std::string::npos ? 0 : std::atoll(head.c_str() + at + field.size());
  return length <= 0 || static_cast<std::size_t>(length) > longest_request ||
         request.size() >= end + 4 + static_cast<std::size_t>(length);
}

} // namespace

struct Doorway::Impl {
  enum class Phase { asking, waiting, taking };

  struct Guest {
    int socket = -1;
    std::uint64_t number = 0;
    Phase phase = Phase::asking;
    std::string bytes; // of the request, then of the answer
    std::size_t sent = 0;
    Clock::time_point deadline = Clock::now() + time_to_ask;
  };

  ~Impl() {
    close(door);
    close(bell);
  }

  Answer answer;
  int door = -1, bell = -1, port = 0;
  std::list<Guest> guests; // in the order they came; the thread `moving` alone uses it
  std::uint64_t next_number = 1;
  std::thread moving;
  std::vector<std::thread> answering;

  std::mutex one_at_a_time; // of what follows
  std::condition_variable asked;
  std::deque<std::pair<std::uint64_t, std::string>> requests, answers;
  bool ends = false;

  void open_door() {
    door = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    bell = eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
    sockaddr_in here{};
    here.sin_family = AF_INET;
    here.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof here;
    if (door < 0 || bell < 0 || bind(door, reinterpret_cast<sockaddr*>(&here), size) != 0 ||
        listen(door, static_cast<int>(most_guests)) != 0 ||
        getsockname(door, reinterpret_cast<sockaddr*>(&here), &size) != 0)
      throw script::FileError("the page: no port of the loopback address can be had");
    port = ntohs(here.sin_port);
  }

  void ring() const {
    const std::uint64_t one = 1;
    [[maybe_unused]] const auto count = write(bell, &one, sizeof one);
  }

  void answer_requests() {
    for (;;) {
      std::unique_lock lock(one_at_a_time);
      asked.wait(lock, [&] { return ends || !requests.empty(); });
      if (requests.empty())
        return;
      auto [number, bytes] = std::move(requests.front());
      requests.pop_front();
      lock.unlock();
      std::string text;
      try {
        text = answer(bytes);
      } catch (const std::exception&) { // the guest sees the end of the connection
      }
      lock.lock();
      answers.emplace_back(number, std::move(text));
      ring();
    }
  }

  void let_in() {
    for (;;) {
      const int socket = accept4(door, nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK);
      if (socket < 0)
        return;
      if (guests.size() >= most_guests) {
        const auto oldest = std::find_if(guests.begin(), guests.end(),
                                         [](const Guest& guest) { return guest.phase == Phase::asking; });
        if (oldest == guests.end()) {
          close(socket);
          continue;
        }
        send_away(oldest);
      }
      Guest guest;
      guest.socket = socket;
      guest.number = next_number++;
      guests.push_back(std::move(guest));
      hear(std::prev(guests.end()));
    }
  }

  void send_away(std::list<Guest>::iterator guest) {
    close(guest->socket);
    guests.erase(guest);
  }

  void hear(std::list<Guest>::iterator guest) {
    std::array<char, 4096> part{};
    for (;;) {
      const auto count = recv(guest->socket, part.data(), part.size(), 0);
      if (count < 0 && (errno == EAGAIN || errno == EINTR))
        return;
      if (count <= 0 || guest->bytes.size() + static_cast<std::size_t>(count) > longest_request)
        return send_away(guest);
      guest->bytes.append(part.data(), static_cast<std::size_t>(count));
      if (!is_whole(guest->bytes))
        continue;
      guest->phase = Phase::waiting;
      const std::lock_guard lock(one_at_a_time);
      requests.emplace_back(guest->number, std::move(guest->bytes));
      asked.notify_one();
      return;
    }
  }

  void tell(std::list<Guest>::iterator guest) {
    while (guest->sent < guest->bytes.size()) {
      const auto count = ::send(guest->socket, guest->bytes.data() + guest->sent,
                                guest->bytes.size() - guest->sent, MSG_NOSIGNAL);
      if (count < 0 && (errno == EAGAIN || errno == EINTR))
        return;
      if (count <= 0)
        break;
      guest->sent += static_cast<std::size_t>(count);
    }
    shutdown(guest->socket, SHUT_WR);
    send_away(guest);
  }

  void take_answers() {
    std::uint64_t rung = 0;
    [[maybe_unused]] const auto count = read(bell, &rung, sizeof rung);
    std::deque<std::pair<std::uint64_t, std::string>> ready;
    {
      const std::lock_guard lock(one_at_a_time);
      ready.swap(answers);
    }
    for (auto& [number, bytes] : ready)
      for (auto guest = guests.begin(); guest != guests.end(); ++guest)
        if (guest->number == number) {
          guest->phase = Phase::taking;
          guest->bytes = std::move(bytes);
          guest->deadline = Clock::now() + time_to_take;
          tell(guest);
          break;
        }
  }

  bool has_ended() {
    const std::lock_guard lock(one_at_a_time);
    return ends;
  }

  // Until the end, and then until those that were being answered have their answers or their time is over.
  void move_bytes() {
    Clock::time_point last = Clock::time_point::max();
    for (;;) {
      if (last == Clock::time_point::max() && has_ended())
        last = Clock::now() + time_to_leave;
      const bool ending = last != Clock::time_point::max();
      const auto now = Clock::now();
      for (auto guest = guests.begin(); guest != guests.end();) {
        const auto here = guest++;
        if ((here->phase == Phase::asking && ending) ||
            (here->phase != Phase::waiting && now >= here->deadline))
          send_away(here);
      }
      if (ending && (guests.empty() || now >= last))
        break;
      std::vector<pollfd> watched{{bell, POLLIN, 0}};
      if (!ending)
        watched.push_back({door, POLLIN, 0});
      std::vector<std::list<Guest>::iterator> who;
      for (auto guest = guests.begin(); guest != guests.end(); ++guest)
        if (guest->phase != Phase::waiting) {
          watched.push_back(
              {guest->socket, static_cast<short>(guest->phase == Phase::asking ? POLLIN : POLLOUT), 0});
          who.push_back(guest);
        }
      poll(watched.data(), watched.size(), ending ? 20 : 200);
      for (std::size_t i = 0; i < who.size(); ++i)
        if (watched[watched.size() - who.size() + i].revents != 0)
          who[i]->phase == Phase::asking ? hear(who[i]) : tell(who[i]);
      take_answers();
      if (!ending)
        let_in();
    }
    while (!guests.empty())
      send_away(guests.begin());
  }
};

Doorway::Doorway() : impl_(std::make_unique<Impl>()) {
  impl_->open_door();
}

void Doorway::open(Answer answer) {
  Impl& all = *impl_;
  all.answer = std::move(answer);
  for (std::size_t i = 0; i < answering_threads; ++i)
    all.answering.emplace_back([&all] { all.answer_requests(); });
  all.moving = std::thread([&all] { all.move_bytes(); });
}

Doorway::~Doorway() {
  Impl& all = *impl_;
  {
    const std::lock_guard lock(all.one_at_a_time);
    all.ends = true;
  }
  all.ring();
  if (all.moving.joinable())
    all.moving.join();
  all.asked.notify_all();
  {
    const std::lock_guard lock(all.one_at_a_time);
    all.requests.clear(); // nobody waits for them
  }
  for (std::thread& thread : all.answering)
    thread.join();
}

int Doorway::port() const {
  return impl_->port;
}

} // namespace cdem::app
