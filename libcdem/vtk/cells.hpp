// Cells of one kind with their points and fields, as one file holds them, and their parts.
#pragma once

#include "libcdem/results/snapshot.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <utility>
#include <vector>

namespace cdem {

template <std::size_t N>
struct Cells {
  std::vector<geom::Vec3> points;          // m
  std::vector<std::array<int, N>> corners; // of each cell, over points
  std::vector<SnapshotField> point_fields, cell_fields;
};

// The same where it stands.
template <std::size_t N>
struct CellsView {
  const std::vector<geom::Vec3>& points;
  const std::vector<std::array<int, N>>& corners;
  const std::vector<SnapshotField>&point_fields, &cell_fields;
};

// Point field of a piece: number of the point in the whole.
inline constexpr const char* point_number = "point_id";

inline SnapshotField rows_of(const SnapshotField& field, const std::vector<std::size_t>& rows) {
  SnapshotField part{field.name, field.unit, field.components, {}, field.integer};
  const auto n = static_cast<std::size_t>(field.components);
  part.values.reserve(n * rows.size());
  for (const std::size_t row : rows)
    for (std::size_t c = 0; c < n; ++c)
      part.values.push_back(field.values[n * row + c]);
  return part;
}

// Cells [begin, end) with the points that they use, in their order, and the numbers of these.
template <std::size_t N>
Cells<N> piece_of(const CellsView<N>& all, std::size_t begin, std::size_t end) {
  std::vector<std::size_t> points, cells;
  for (std::size_t i = begin; i < end; ++i) {
    cells.push_back(i);
    for (const int corner : all.corners[i])
      points.push_back(static_cast<std::size_t>(corner));
  }
  std::sort(points.begin(), points.end());
  points.erase(std::unique(points.begin(), points.end()), points.end());
  Cells<N> piece;
  SnapshotField number{point_number, "", 1, {}, true};
  for (const std::size_t point : points) {
    piece.points.push_back(all.points[point]);
    number.values.push_back(static_cast<double>(point));
  }
  for (std::size_t i = begin; i < end; ++i) {
    std::array<int, N> corners{};
    for (std::size_t c = 0; c < N; ++c)
      corners[c] = static_cast<int>(
          std::lower_bound(points.begin(), points.end(), static_cast<std::size_t>(all.corners[i][c])) -
          points.begin());
    piece.corners.push_back(corners);
  }
  for (const SnapshotField& field : all.point_fields)
    piece.point_fields.push_back(rows_of(field, points));
  piece.point_fields.push_back(std::move(number));
  for (const SnapshotField& field : all.cell_fields)
    piece.cell_fields.push_back(rows_of(field, cells));
  return piece;
}

// The whole that has been written in pieces, in their order. Returns what is wrong with them, "" where nothing is.
template <std::size_t N>
std::string join(const std::vector<Cells<N>>& pieces, Cells<N>& all) {
  const auto same = [](const std::vector<SnapshotField>& a, const std::vector<SnapshotField>& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [](const SnapshotField& one, const SnapshotField& other) {
                        return one.name == other.name && one.components == other.components;
                      });
  };
  constexpr double most_points = 2147483647; // as corners are int
  std::vector<std::size_t> numbers;          // of points, in all pieces
  for (const Cells<N>& piece : pieces) {
    if (piece.point_fields.empty() || piece.point_fields.back().name != point_number ||
        piece.point_fields.back().components != 1 || !same(piece.point_fields, pieces[0].point_fields) ||
        !same(piece.cell_fields, pieces[0].cell_fields))
      return "its pieces are not of one file";
    for (const double number : piece.point_fields.back().values) {
      if (!(number >= 0 && number < most_points))
        return "it is damaged: a piece numbers a point wrongly";
      numbers.push_back(static_cast<std::size_t>(number));
    }
  }
  std::sort(numbers.begin(), numbers.end());
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
  const auto empty = [](const std::vector<SnapshotField>& like, std::size_t fields, std::size_t rows) {
    std::vector<SnapshotField> made;
    for (std::size_t f = 0; f < fields; ++f)
      made.push_back({like[f].name, like[f].unit, like[f].components,
                      std::vector<double>(rows * static_cast<std::size_t>(like[f].components)),
                      like[f].integer});
    return made;
  };
  all = {};
  if (pieces.empty())
    return "";
  all.points.resize(numbers.size());
  all.point_fields = empty(pieces[0].point_fields, pieces[0].point_fields.size() - 1, numbers.size());
  all.cell_fields = empty(pieces[0].cell_fields, pieces[0].cell_fields.size(), 0);
  for (const Cells<N>& piece : pieces) {
    std::vector<int> now; // of each of its points, the place in the whole
    for (const double number : piece.point_fields.back().values)
      now.push_back(static_cast<int>(
          std::lower_bound(numbers.begin(), numbers.end(), static_cast<std::size_t>(number)) -
          numbers.begin()));
    for (std::size_t p = 0; p < now.size(); ++p)
      all.points[static_cast<std::size_t>(now[p])] = piece.points[p];
    for (std::size_t f = 0; f < all.point_fields.size(); ++f) {
      const std::ptrdiff_t n = all.point_fields[f].components;
      for (std::size_t p = 0; p < now.size(); ++p)
        std::copy_n(piece.point_fields[f].values.begin() + n * static_cast<std::ptrdiff_t>(p), n,
                    all.point_fields[f].values.begin() + n * now[p]);
    }
    for (std::array<int, N> corners : piece.corners) {
      for (int& corner : corners)
        corner = now[static_cast<std::size_t>(corner)];
      all.corners.push_back(corners);
    }
    for (std::size_t f = 0; f < all.cell_fields.size(); ++f)
      all.cell_fields[f].values.insert(all.cell_fields[f].values.end(), piece.cell_fields[f].values.begin(),
                                       piece.cell_fields[f].values.end());
  }
  return "";
}

} // namespace cdem
