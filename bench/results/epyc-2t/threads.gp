# Draws threads.png: gnuplot threads.gp
if (!exists('ending')) ending = ''
if (strstrt(GPVAL_TERMINALS, 'pngcairo') > 0) {
    set terminal pngcairo size 1100,700 font 'DejaVu Sans,14' background 'white'
} else {
    set terminal png size 1100,700
}
set encoding utf8
set datafile missing 'nan'
set grid linetype 1 linecolor '#c8c8c8' linewidth 1
set border linecolor '#404040'
set key outside right top Left reverse noenhanced
set tics nomirror
set format y '%g'
set style line 1 linecolor '#0072B2' linewidth 2 pointtype 7 pointsize 2.2
set style line 2 linecolor '#D55E00' linewidth 2 pointtype 5 pointsize 1.7
set style line 3 linecolor '#009E73' linewidth 2 pointtype 9 pointsize 1.7
set output 'threads.png'.ending
set title 'Speedup over one thread'
set key outside top center horizontal
set xlabel 'threads'
set ylabel 'times as fast as one thread'
set logscale xy 2
set xtics (1, 2)
set xrange [0.9091:2.2]
$case0 << EOD
1 1 1
2 1.92265 2.0602
EOD
$case1 << EOD
1 1 1
2 1.97495 1.9199
EOD
$case2 << EOD
1 1 1
2 2.0923 1.88219
EOD
plot x with lines linecolor '#a0a0a0' title 'ideal', \
     $case0 using 1:2 with linespoints linestyle 1 title 'gas', \
     $case0 using 1:3 with linespoints linestyle 1 dashtype 2 title 'gas, bare rays', \
     $case1 using 1:2 with linespoints linestyle 2 title 'settle', \
     $case1 using 1:3 with linespoints linestyle 2 dashtype 2 title 'settle, bare rays', \
     $case2 using 1:2 with linespoints linestyle 3 title 'pinball', \
     $case2 using 1:3 with linespoints linestyle 3 dashtype 2 title 'pinball, bare rays'
set output
