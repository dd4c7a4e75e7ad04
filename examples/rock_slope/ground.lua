-- Ground of 60 x 8 x 32 m for the script beside this file: a fault dips out of the slope through (39, 14), below it the rock is
-- massive, above it jointed. A face of 65 degrees rises from the floor of the excavation at (40, 12). Its outline is cut into
-- the rock beforehand and glued: it is no joint.
local cdem = require "cdem"

local ground = { length = 60, width = 8, height = 32, floor = 12 } -- m
local tangent = math.tan(math.rad(65))

-- A prism through the whole width, with the outline of the excavation.
local function prism(points)
  local corners = {}
  for _, y in ipairs{ 0, ground.width } do
    for _, p in ipairs(points) do corners[#corners + 1] = { p[1], y, p[2] } end
  end
  local shape = cdem.convex_hull{ points = corners }
  shape = cdem.cut_by_plane{ shape = shape, point = {40, 0, ground.floor}, normal = {tangent, 0, 1}, name = "face",
                             glued = true }
  return cdem.cut_by_plane{ shape = shape, point = {40, 0, ground.floor}, normal = {0, 0, 1}, name = "floor", glued = true }
end

function ground.shape(dip, sets, seed, smallest)
  local run = 1 / math.tan(math.rad(dip))
  local foot, head = { 39 + 14 * run, 0 }, { 39 - 18 * run, ground.height } -- ends of the fault
  function ground.slides(x, _, z) return z > ground.floor and z - 14 > (39 - x) / run end
  local jointed = prism{ foot, {60, 0}, {60, 32}, head }
  jointed = cdem.cut_by_joints{ shape = jointed, sets = sets, seed = seed, smallest = smallest }
  return cdem.merge{ shapes = { prism{ {0, 0}, foot, head, {0, 32} }, jointed } }
end

-- What lies in front of the face and above the floor.
function ground.dug(x, _, z) return z > ground.floor and z - ground.floor > -tangent * (x - 40) end

return ground
