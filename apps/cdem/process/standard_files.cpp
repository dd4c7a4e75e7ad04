#include "apps/cdem/process/standard_files.hpp"

#include <array>
#include <cerrno>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <stdexcept>

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

namespace cdem::app {

namespace {

constexpr std::size_t standard_files = 3;

// An abstract name: no file stands for it.
sockaddr_un address_of(const std::string& name, socklen_t& size) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::memcpy(address.sun_path + 1, name.data(), std::min(name.size(), sizeof address.sun_path - 1));
  size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + name.size());
  return address;
}

// A message of one byte, with the three files beside it.
struct Message {
  char byte = 0;
  iovec part{&byte, 1};
  alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof(int) * standard_files)> beside{};
  msghdr head{};
  Message() {
    head.msg_iov = &part;
    head.msg_iovlen = 1;
    head.msg_control = beside.data();
    head.msg_controllen = beside.size();
  }
  Message(const Message&) = delete;
  Message& operator=(const Message&) = delete;
};

} // namespace

int take_standard_files() {
  const char* const name = std::getenv(starter_variable);
  if (!name)
    return -1;
  const int file = socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0);
  socklen_t size = 0;
  const sockaddr_un address = address_of(name, size);
  Message message;
  if (connect(file, reinterpret_cast<const sockaddr*>(&address), size) != 0 ||
      recvmsg(file, &message.head, MSG_CMSG_CLOEXEC) <= 0) {
    close(file);
    return -1;
  }
  const cmsghdr* const head = CMSG_FIRSTHDR(&message.head);
  if (head && head->cmsg_type == SCM_RIGHTS && head->cmsg_len == CMSG_LEN(sizeof(int) * standard_files)) {
    std::array<int, standard_files> files{};
    std::memcpy(files.data(), CMSG_DATA(head), sizeof files);
    for (std::size_t i = 0; i < files.size(); ++i) {
      dup2(files[i], static_cast<int>(i));
      close(files[i]);
    }
  }
  return file;
}

StandardFiles::StandardFiles() : waiting_(socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC | SOCK_NONBLOCK, 0)) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  socklen_t size = sizeof address.sun_family; // the system finds a name that is free
  const bool waits =
      bind(waiting_, reinterpret_cast<const sockaddr*>(&address), size) == 0 && listen(waiting_, 1) == 0;
  size = sizeof address;
  if (!waits || getsockname(waiting_, reinterpret_cast<sockaddr*>(&address), &size) != 0)
    throw std::runtime_error(std::string("no socket for the ranks: ") + std::strerror(errno));
  const std::string name(address.sun_path + 1, size - offsetof(sockaddr_un, sun_path) - 1);
  setenv(starter_variable, name.c_str(), 1);
}

StandardFiles::~StandardFiles() {
  for (const int file : {waiting_, connected_})
    if (file >= 0)
      close(file);
}

void StandardFiles::look() {
  if (connected_ < 0)
    give();
  unsigned char code = 0;
  if (connected_ >= 0 && recv(connected_, &code, 1, MSG_DONTWAIT) == 1)
    exit_code_ = code;
}

void StandardFiles::give() {
  const int file = accept4(waiting_, nullptr, nullptr, SOCK_CLOEXEC);
  if (file < 0)
    return;
  ucred who{};
  socklen_t size = sizeof who;
  if (getsockopt(file, SOL_SOCKET, SO_PEERCRED, &who, &size) != 0 || who.uid != geteuid()) {
    close(file);
    return;
  }
  Message message;
  cmsghdr* const head = CMSG_FIRSTHDR(&message.head);
  head->cmsg_level = SOL_SOCKET;
  head->cmsg_type = SCM_RIGHTS;
  head->cmsg_len = CMSG_LEN(sizeof(int) * standard_files);
  const std::array<int, standard_files> files{STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO};
  std::memcpy(CMSG_DATA(head), files.data(), sizeof files);
  sendmsg(file, &message.head, MSG_NOSIGNAL);
  connected_ = file;
  process_ = who.pid;
}

} // namespace cdem::app
