"""Responses: motions under forces, their rows and what is read off them."""

from mechkin_cli.analysis.response.respond import integrated, prepare, read, respond
from mechkin_cli.analysis.response.result import ResponseResult

__all__ = ["ResponseResult", "integrated", "prepare", "read", "respond"]
