// Asks the search of the built book what newcomers ask, and says which page it finds first. Exit code 1 if it is another
// than the one that answers.
//
//     mdbook build docs/book && node docs/book/questions.js

const fs = require("fs");
const path = require("path");

const QUESTIONS = [
  ["how do I run only part 3", "run.html"],
  ["what does inconclusive mean", "verdicts.html"],
  ["my renderer is y-down", "conventions.html"],
  ["grade my class", "grading.html"],
  ["make a reference", "references.html"],
  ["how fast is my BVH", "part-2.html"],
];

const book = path.join(__dirname, "../../target/book");
const built = (pattern) => path.join(book, fs.readdirSync(book).find((name) => pattern.test(name)));
const elasticlunr = require(built(/^elasticlunr.*\.js$/));
const window = { search: {} };
eval(fs.readFileSync(built(/^searchindex.*\.js$/), "utf8"));
const { index, doc_urls, search_options } = window.search;
const search = elasticlunr.Index.load(index);

let isWrong = false;
for (const [question, page] of QUESTIONS) {
  const found = search.search(question, search_options).map((result) => doc_urls[result.ref]);
  const isFirst = (found[0] || "").startsWith(page);
  isWrong = isWrong || !isFirst;
  console.log(`${isFirst ? "ok   " : "WRONG"} ${question}: ${found.slice(0, 3).join("  ")}`);
}
process.exit(isWrong ? 1 : 0);
