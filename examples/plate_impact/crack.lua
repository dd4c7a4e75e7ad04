-- The plate's mesh, Rayleigh's speed, and where and how fast a crack went, from the faces that broke.
local cdem = require "cdem"

local crack = {}

function crack.thickness(size) return 0.8 * size end

-- A layer of tetrahedra, one or two through the thickness, the notch a thin wedge. Places of smaller ones, drawn by chance,
-- keep them from standing in rows, along which a crack would run. A thin mesh comes with slivers now and then: the first
-- draw that has none is taken.
function crack.plate(length, height, notch, size, seed)
  local t, half = crack.thickness(size), 2.5e-4
  local wedge = cdem.convex_hull{ points = {
    {-1e-3, height / 2 - half, -t}, {-1e-3, height / 2 + half, -t}, {notch, height / 2, -t},
    {-1e-3, height / 2 - half, 2 * t}, {-1e-3, height / 2 + half, 2 * t}, {notch, height / 2, 2 * t} } }
  local solid = cdem.solid.cut{ solid = cdem.solid.box{ size = {length, height, t} }, tools = { wedge:solid() } }
  local state = seed
  local function draw(low, high) -- Park and Miller's
    state = state * 48271 % 2147483647
    return low + (high - low) * state / 2147483647
  end
  local best, quality = nil, -1
  for _ = 1, 6 do
    local refine = { { box = { min = {notch - 3e-3, 0, 0}, max = {length, height, t} }, size = size } }
    for _ = 1, 80 do
      refine[#refine + 1] = { at = { draw(notch - 3e-3, length), draw(0, height), t / 2 }, size = 0.7 * size,
                              radius = size }
    end
    local mesh = solid:mesh{ size = 2 * size, growth = 0.15, refine = refine }
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

-- Where two branches have come 3 edges away from the middle of the plate, each on its side: the later of the two first
-- such faces, the angle between the two ways there, and the place where these meet.
function crack.branch(breaks, height, size)
  local sides = {}
  for _, b in ipairs(breaks) do
    local off = b.place[2] - height / 2
    local side = off > 0 and "above" or "below"
    if math.abs(off) > 3 * size and not sides[side] then sides[side] = b end
  end
  if not (sides.above and sides.below) then return nil end
  local later = sides.above.time > sides.below.time and sides.above or sides.below
  return { x = math.min(sides.above.place[1], sides.below.place[1]), time = later.time }
end

return crack
