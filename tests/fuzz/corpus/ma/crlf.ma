# from elsewhere
3 1 1
v 0 0 0 1 0.5 extra

v 1 0 0 1
v 0 1 0 1e-3
e 2 0
f 2 0 1
