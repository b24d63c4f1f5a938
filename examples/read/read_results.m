% Reads what orchard writes with MATLAB or Octave: an axis and a tree.
%   read_results(FOLDER, MODEL), after
%   orchard medial MODEL.obj -o FOLDER --export csv
%   orchard build MODEL.obj -o FOLDER
function read_results(folder, model)
  balls = csvread(fullfile(folder, [model '-axis-balls.csv']), 1, 0);
  contacts = csvread(fullfile(folder, [model '-axis-contacts.csv']), 1, 0);
  triangles = csvread(fullfile(folder, [model '-axis-triangles.csv']), 1, 0) + 1;
  owner = contacts(:, 1) + 1;
  distance = sqrt(sum((contacts(:, 2:4) - balls(owner, 1:3)).^2, 2));
  printf('%d balls, radii %.3g to %.3g, %d triangles\n', rows(balls), min(balls(:, 4)), max(balls(:, 4)), rows(triangles));
  printf('contacts are off the radius by %.2g at most\n', max(abs(distance - balls(owner, 4))));

  lines = strsplit(fileread(fullfile(folder, [model '.sph'])), "\n");
  lines = lines(~strncmp(lines, '#', 1) & ~cellfun(@isempty, lines));
  head = sscanf(lines{1}, '%d');
  nodes = reshape(sscanf(strjoin(lines(2:end), "\n"), '%f'), 5, [])';
  spheres = nodes(nodes(:, 4) > 0, :);
  printf('%d spheres on %d levels, the root of radius %.3g\n', rows(spheres), head(1), spheres(1, 4));
end
