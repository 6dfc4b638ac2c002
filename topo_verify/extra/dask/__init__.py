"""A search on a Dask cluster.

options.py   the option --dask
backend.py   the backend: shards are examined by the workers of a cluster
cluster.py   a connected cluster, and a pool of tasks on it
worker.py    what runs on a Dask worker
"""
