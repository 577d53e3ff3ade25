"""From the bytes of a YAML file to plain data in which every value still knows its line and column.

text -> events -> nodes -> plain data: `text` decodes, `parser` walks the events, `document` answers
where a value stands, `explain` turns errors of a validation into messages with a place.
"""
