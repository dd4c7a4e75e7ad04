-- The plate's mesh, Rayleigh's speed, and where and how fast a crack went, from the faces that broke.
local cdem = require "cdem"

local crack = {}

function crack.thickness(size) return 0.8 * size end

-- A layer of tetrahedra, one or two through the thickness, the notch a thin wedge. Left alone the mesher sets them in
-- rows; irregular: places of smaller ones, drawn by chance, break the rows. A thin mesh comes with slivers now and then:
-- the first of some that has none is taken.
function crack.plate(length, height, notch, size, irregular)
  local t, half = crack.thickness(size), 2.5e-4
  local wedge = cdem.convex_hull{ points = {
    {-1e-3, height / 2 - half, -t}, {-1e-3, height / 2 + half, -t}, {notch, height / 2, -t},
    {-1e-3, height / 2 - half, 2 * t}, {-1e-3, height / 2 + half, 2 * t}, {notch, height / 2, 2 * t} } }
  local solid = cdem.solid.cut{ solid = cdem.solid.box{ size = {length, height, t} }, tools = { wedge:solid() } }
  local state = 1
  local function draw(low, high) -- Park and Miller's
    state = state * 48271 % 2147483647
    return low + (high - low) * state / 2147483647
  end
  local best, quality = nil, -1
  for attempt = 0, 5 do
    local asked = { size = size * (1 - 0.01 * attempt) }
    if irregular then
      asked = { size = 2 * size, growth = 0.15,
                refine = { { box = { min = {notch - 3e-3, 0, 0}, max = {length, height, t} }, size = size } } }
      for _ = 1, 80 do
        asked.refine[#asked.refine + 1] = { at = { draw(notch - 3e-3, length), draw(0, height), t / 2 },
                                            size = 0.7 * size, radius = size }
      end
    end
    local mesh = solid:mesh(asked)
    local found = mesh:quality().min_radius_ratio
    if found > quality then best, quality = mesh, found end
    if found > 0.1 then break end
  end
  return best
end

-- c_R: the root below 1 of (2 - x^2)^2 = 4 sqrt(1 - x^2) sqrt(1 - a x^2), x = c_R / c_s, a = (c_s / c_d)^2.
function crack.rayleigh_speed(shear_speed, nu)
  local a = (1 - 2 * nu) / (2 * (1 - nu))
  local low, high = 0.5, 1 - 1e-9
  for _ = 1, 60 do
    local x2 = ((low + high) / 2) ^ 2
    if (2 - x2) ^ 2 < 4 * math.sqrt((1 - x2) * (1 - a * x2)) then low = math.sqrt(x2) else high = math.sqrt(x2) end
  end
  return shear_speed * low
end

-- The foremost broken face over time, and its speed: the slope of a straight line through five samples.
function crack.path(breaks, notch, duration, samples)
  local path = { time = {}, tip = {}, speed = {}, starts = nil }
  local tip, k = notch, 1
  for i = 1, samples do
    local time = duration * i / samples
    while breaks[k] and breaks[k].time <= time do
      if breaks[k].place[1] > notch and not path.starts then path.starts = breaks[k].time end
      tip, k = math.max(tip, breaks[k].place[1]), k + 1
    end
    path.time[i], path.tip[i] = time, tip
  end
  for i = 1, samples do
    local first, last = math.max(1, i - 2), math.min(samples, i + 2)
    local n, st, sx, stt, stx = 0, 0, 0, 0, 0
    for j = first, last do
      local t, x = path.time[j], path.tip[j]
      n, st, sx, stt, stx = n + 1, st + t, sx + x, stt + t * t, stx + t * x
    end
    path.speed[i] = (n * stx - st * sx) / (n * stt - st * st)
  end
  return path
end

-- Where the crack has parted: at the smallest x at which broken faces lie `apart` above and below each other, from which
-- on both go on for as much again; when the later of the two reached it.
function crack.branch(breaks, notch, length, apart)
  local bins = {}
  for _, b in ipairs(breaks) do
    local i = math.floor((b.place[1] - notch) / apart)
    if i >= 0 then
      local bin = bins[i] or { low = b, high = b }
      if b.place[2] < bin.low.place[2] then bin.low = b end
      if b.place[2] > bin.high.place[2] then bin.high = b end
      bins[i] = bin
    end
  end
  local function parted(i) return bins[i] and bins[i].high.place[2] - bins[i].low.place[2] > apart end
  for i = 0, math.floor((length - notch) / apart) do
    if parted(i) and parted(i + 1) then
      return { x = notch + i * apart, time = math.max(bins[i].low.time, bins[i].high.time) }
    end
  end
end

return crack
