// What follows from a model alone and takes long to find, kept for the next stage of the same model: a script runs many
// stages of one, and begins each as if it were the first.
#pragma once

#include "libcdem/model/model.hpp"

#include <array>
#include <memory>
#include <mutex>

namespace cdem {

// Tells whether a model is still what it was, by the bytes of all its members (checkpoint/model_archive.cpp), at the speed of
// memory. It means nothing in another run.
std::uint64_t fingerprint(const Model&);

template <class T>
class KnownOfModel {
public:
  // make(): T, from this model alone. The answers for the last two models are kept.
  template <class Make>
  std::shared_ptr<const T> of(const Model& model, const Make& make) {
    const std::uint64_t key = fingerprint(model);
    const std::lock_guard lock(mutex_);
    if (known_[1].answer && known_[1].key == key)
      std::swap(known_[0], known_[1]);
    if (!known_[0].answer || known_[0].key != key) {
      known_[1] = std::move(known_[0]);
      known_[0] = {key, std::make_shared<const T>(make())};
    }
    return known_[0].answer;
  }

private:
  struct Known {
    std::uint64_t key = 0;
    std::shared_ptr<const T> answer;
  };
  std::mutex mutex_;
  std::array<Known, 2> known_; // the one asked for last first
};

} // namespace cdem
