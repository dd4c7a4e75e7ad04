-- Lines {x, y} of a crack from its mouth up to its tip, and how far they are from each other.
local path = {}

-- Where a line crosses a height: x, or nil above its tip.
function path.x_at(line, y)
  for i = 2, #line do
    local a, b = line[i - 1], line[i]
    if math.min(a[2], b[2]) <= y + 1e-9 and math.max(a[2], b[2]) >= y - 1e-9 and a[2] ~= b[2] then
      return a[1] + (b[1] - a[1]) * (y - a[2]) / (b[2] - a[2])
    end
  end
end

-- Root mean square of the horizontal distance to reference points, over those heights that the line reaches; their number.
function path.rms_to_points(line, points)
  local sum, count = 0, 0
  for _, point in ipairs(points) do
    local x = path.x_at(line, point[2])
    if x then sum, count = sum + (x - point[1]) ^ 2, count + 1 end
  end
  return count > 0 and math.sqrt(sum / count) or nil, count
end

local function distance_to_piece(p, a, b)
  local dx, dy = b[1] - a[1], b[2] - a[2]
  local along = dx * dx + dy * dy
  local t = along > 0 and math.max(0, math.min(1, ((p[1] - a[1]) * dx + (p[2] - a[2]) * dy) / along)) or 0
  return math.sqrt((p[1] - a[1] - t * dx) ^ 2 + (p[2] - a[2] - t * dy) ^ 2)
end

local function distance_to_line(p, line)
  local least = math.huge
  for i = 2, #line do least = math.min(least, distance_to_piece(p, line[i - 1], line[i])) end
  return least
end

local function add_distances(from, to, top, sum)
  for i = 2, #from do
    local a, b = from[i - 1], from[i]
    local length = math.sqrt((b[1] - a[1]) ^ 2 + (b[2] - a[2]) ^ 2)
    local pieces = math.max(1, math.ceil(length / 1e-3))
    for k = 1, pieces do
      local t = (k - 0.5) / pieces
      local p = {a[1] + t * (b[1] - a[1]), a[2] + t * (b[2] - a[2])}
      if p[2] <= top then
        local d = distance_to_line(p, to)
        sum.square, sum.length = sum.square + length / pieces * d * d, sum.length + length / pieces
        sum.most = math.max(sum.most, d)
      end
    end
  end
end

-- Distance between two lines up to the lower one's tip, from each to the nearest place of the other: rms over their
-- length, and the largest, m.
function path.distance(one, other)
  local sum = { square = 0, length = 0, most = 0 }
  local top = math.min(one[#one][2], other[#other][2])
  add_distances(one, other, top, sum)
  add_distances(other, one, top, sum)
  return math.sqrt(sum.square / sum.length), sum.most
end

-- Sum of a line's turns, degrees, and its length over the straight distance from its first to its last point.
function path.wandering(line)
  local turns, length, before = 0, 0, nil
  for i = 2, #line do
    local dx, dy = line[i][1] - line[i - 1][1], line[i][2] - line[i - 1][2]
    local angle = math.deg(math.atan(dy, dx))
    if before then turns = turns + math.abs((angle - before + 180) % 360 - 180) end
    length, before = length + math.sqrt(dx * dx + dy * dy), angle
  end
  local first, last = line[1], line[#line]
  return turns, length / math.sqrt((last[1] - first[1]) ^ 2 + (last[2] - first[2]) ^ 2)
end

return path
