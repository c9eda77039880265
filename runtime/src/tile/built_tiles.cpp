// SPDX-License-Identifier: BSD-3-Clause
//
// Makes the builders of tiles, and keeps the tiles.
#include "tile/built_tiles.hpp"

#include "tile/five_cube_tile.hpp"

namespace tegl::detail {

namespace {

/// Builds barycentric tiles by the general builder.
class GeneralMaker final : public TileMaker {
 public:
  GeneralMaker(const CubeFaces& cube, tile::Alternative alternative, std::size_t max_bytes)
      : cube_(cube), alternative_(alternative), builder_(tile::FaceLattice::cube(cube.dim()), max_bytes) {}

  BuiltTile make(const TileKey& key) override {
    choices_.clear();
    if (key.has_choices()) {
      choices_.assign(cube_.cells().size(), tile::Choice::separate);
      for (std::size_t face = cube_.first_choice(); face < choices_.size(); ++face)
        choices_[face] = key.choice(face - cube_.first_choice());
    }
    return too_large_as_error([&] {
      return BuiltTile(cube_, builder_.build(key.signature, {.choices = choices_, .alternative = alternative_}));
    });
  }
  [[nodiscard]] std::size_t kept_bytes() const override { return builder_.kept_bytes(); }

 private:
  CubeFaces cube_;
  tile::Alternative alternative_;
  tile::FacetBuilder builder_;
  std::vector<tile::Choice> choices_;
};

}  // namespace

BuiltTiles::BuilderLoan::BuilderLoan(BuiltTiles& from) : from_(from) {
  const std::lock_guard lock(from_.mutex_);
  if (from_.builders_.empty()) {
    from_.builders_.reserve(from_.made_ + 1);  // so that returning a builder cannot throw
    if (from_.kind_.triangulation == Triangulation::compact)
      builder_ = five_cube_maker(from_.kind_);
    else
      builder_ = std::make_unique<GeneralMaker>(from_.cube_, from_.kind_.alternative, from_.max_builder_bytes_);
    ++from_.made_;
  } else {
    builder_ = std::move(from_.builders_.back());
    from_.builders_.pop_back();
  }
}

BuiltTiles::BuilderLoan::~BuilderLoan() {
  const std::lock_guard lock(from_.mutex_);
  from_.builders_.push_back(std::move(builder_));
}

BuiltTiles::Pointer BuiltTiles::BuilderLoan::build(const TileKey& key) const {
  return std::make_shared<const BuiltTile>(builder_->make(key));
}

std::size_t BuiltTiles::kept_bytes() {
  const std::lock_guard lock(mutex_);
  std::size_t bytes = bytes_;
  for (const auto& builder : builders_) bytes += builder->kept_bytes();
  return bytes;
}

void BuiltTiles::keep(const TileKey& key, const Pointer& tile) {
  const std::size_t bytes = tile->bytes();
  if (bytes_ + bytes > max_bytes_) {
    known_.clear();  // frequent ones are soon built again
    bytes_ = 0;
  }
  if (bytes > max_bytes_) return;
  bytes_ += bytes;
  known_.emplace(key, tile);
}

}  // namespace tegl::detail
