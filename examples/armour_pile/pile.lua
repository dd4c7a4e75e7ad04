-- The slope, the side walls and the units of Feng 2014 section 4, for the scripts of this example.
local cdem = require "cdem"
local M = {}

M.density, M.water, M.gradient, M.g = 2500, 1025, 1 / 1.5, 9.81

-- The ground's mesh, its toe at the origin.
function M.slope(length, width, height)
  return cdem.slope{ gradient = M.gradient, length = length, width = width }:mesh{ size = 3 * height }
end

-- A camera at the side of the toe and above which sees these points {x, y, z}, m.
local function camera_on(points)
  local back = {-0.600, -0.556, 0.576} -- from what it looks at to where it stands
  local axes = { {0.680, -0.734, 0}, {0.423, 0.391, 0.818}, back } -- right, up
  local function along(axis, point) return axis[1] * point[1] + axis[2] * point[2] + axis[3] * point[3] end
  local middle = {0, 0, 0}
  for _, axis in ipairs(axes) do
    local least, most = math.huge, -math.huge
    for _, point in ipairs(points) do
      least, most = math.min(least, along(axis, point)), math.max(most, along(axis, point))
    end
    for k = 1, 3 do middle[k] = middle[k] + 0.5 * (least + most) * axis[k] end
  end
  local half_height, half_width = math.tan(math.rad(14)), 1.1 * math.tan(math.rad(14)) -- a bar of colours stands beside
  local distance, position = 0, {}
  for _, point in ipairs(points) do
    local way = {point[1] - middle[1], point[2] - middle[2], point[3] - middle[3]}
    distance = math.max(distance, along(back, way) + math.abs(along(axes[1], way)) / half_width,
                        along(back, way) + math.abs(along(axes[2], way)) / half_height)
  end
  for k = 1, 3 do position[k] = middle[k] + distance * back[k] end
  return { position = position, focal_point = middle, up = {0, 0, 1}, view_angle = 31 }
end

-- A model of the pile on a slope, between walls if wanted. Options: length of the slope, m; friction_angle, degrees, of
-- everything on everything; walls, true or false; stiffness_damping of the units, s. Bodies "slope", "units", "walls";
-- nothing but the ground and the walls is held yet. Returns the model and { names of ground and walls, weight = of these
-- in water, N; camera }.
function M.model(pile, options)
  local height, box, length = pile.height, pile:box(), options.length
  local concrete = cdem.elastic{ youngs_modulus = 30e9, poissons_ratio = 0.25, density = M.density,
                                 stiffness_damping = options.stiffness_damping }
  local width = 2 * math.max(-box.min[2], box.max[2]) + 2 * height
  local slope = M.slope(length, width, height)
  local bodies = { { shape = slope, material = concrete, element = "rigid", name = "slope" },
                   { shape = pile, material = concrete, name = "units" } }
  if options.walls then
    bodies[3] = { shape = pile:walls{ onto = slope }, material = concrete, element = "rigid", name = "walls" }
  end
  local model = cdem.model{ bodies = bodies,
                            contacts = { default = cdem.coulomb{ friction_angle = options.friction_angle } } }
  local seen, rise = {}, M.gradient * length
  for _, y in ipairs{-width / 2, width / 2} do
    for _, corner in ipairs{ {0, y, 0}, {length, y, 0}, {length, y, rise} } do seen[#seen + 1] = corner end
  end
  for _, pose in ipairs(pile:poses()) do
    local x, y, z = table.unpack(pose.centroid)
    for _, side in ipairs{-0.5, 0.5} do
      seen[#seen + 1] = {x + side * height, y - side * height, z}
      seen[#seen + 1] = {x, y, z + side * height}
    end
  end
  local ground = { weight = 0, camera = camera_on(seen) }
  for _, body in ipairs(bodies) do
    if body.name ~= "units" then
      ground[#ground + 1] = body.name
      ground.weight = ground.weight + body.shape:volume() * (M.density - M.water) * M.g
      model:fix{ on = body.name }
    end
  end
  model:gravity{ vector = {0, 0, -M.g}, water_density = M.water }
  return model, ground
end

-- How far each unit has gone between two lists of poses, m.
function M.ways(from, to)
  local ways = {}
  for i, pose in ipairs(to) do
    local way = 0
    for k = 1, 3 do way = way + (pose.centroid[k] - from[i].centroid[k]) ^ 2 end
    ways[i] = math.sqrt(way)
  end
  return ways
end

-- A picture of the model from the side of the toe and above. Units are coloured, the ground is not, walls would hide them.
-- ground is that of M.model; `options` those of model:picture that differ from picture to picture. Frames of a film look
-- from one place, other pictures from where the model fills the frame.
function M.picture(model, ground, options)
  options.deformation = 1
  if options.film then
    options.film, options.camera, options.axes = nil, ground.camera, false
  else
    options.view, options.up, options.size = "iso", "z", {1600, 0}
  end
  options.plain, options.hidden = {"slope"}, {}
  for _, name in ipairs(ground) do
    if name ~= "slope" then table.insert(options.hidden, name) end
  end
  model:picture(options)
end

return M
