#include "libcdem/ranks/links.hpp"

#include <algorithm>
#include <cstring>

namespace cdem {

void Links::set(std::vector<std::int32_t> needs, const std::function<int(std::int64_t)>& owner) {
  Ranks& all = ranks();
  std::sort(needs.begin(), needs.end());
  needs.erase(std::unique(needs.begin(), needs.end()), needs.end());
  const auto size = static_cast<std::size_t>(all.size());
  send_.assign(size, {});
  receive_.assign(size, {});
  for (const std::int32_t entry : needs)
    if (const int of = owner(entry); of != all.rank())
      receive_[of].push_back(entry);
  std::vector<std::string> told(size);
  for (std::size_t r = 0; r < size; ++r)
    told[r].assign(reinterpret_cast<const char*>(receive_[r].data()),
                   receive_[r].size() * sizeof(std::int32_t));
  const std::vector<std::string> heard = all.deal(told);
  for (std::size_t r = 0; r < size; ++r) {
    send_[r].resize(heard[r].size() / sizeof(std::int32_t));
    std::memcpy(send_[r].data(), heard[r].data(), heard[r].size());
  }
  sent_.resize(size);
  received_.resize(size);
}

std::size_t Links::received() const {
  std::size_t sum = 0;
  for (const std::vector<std::int32_t>& of : receive_)
    sum += of.size();
  return sum;
}

void Links::share(const std::vector<Array>& arrays) {
  if (send_.empty()) // nothing is told
    return;
  std::size_t bytes = 0;
  for (const Array& array : arrays)
    bytes += array.bytes;
  std::vector<Ranks::Parcel> send, receive;
  for (std::size_t r = 0; r < send_.size(); ++r) {
    if (!receive_[r].empty()) {
      received_[r].resize(receive_[r].size() * bytes);
      receive.push_back({static_cast<int>(r), received_[r].data(), received_[r].size()});
    }
    if (send_[r].empty())
      continue;
    sent_[r].resize(send_[r].size() * bytes);
    char* to = sent_[r].data();
    for (const Array& array : arrays)
      for (const std::int32_t entry : send_[r]) {
        std::memcpy(to, static_cast<const char*>(array.data) + array.bytes * static_cast<std::size_t>(entry),
                    array.bytes);
        to += array.bytes;
      }
    send.push_back({static_cast<int>(r), sent_[r].data(), sent_[r].size()});
  }
  ranks().exchange(send, receive);
  for (std::size_t r = 0; r < receive_.size(); ++r) {
    const char* from = received_[r].data();
    for (const Array& array : arrays)
      for (const std::int32_t entry : receive_[r]) {
        std::memcpy(static_cast<char*>(array.data) + array.bytes * static_cast<std::size_t>(entry), from,
                    array.bytes);
        from += array.bytes;
      }
  }
}

} // namespace cdem
